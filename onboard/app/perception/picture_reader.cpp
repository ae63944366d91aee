// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/picture_reader.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>
#include <string>

#include "onboard/perception/health/picture_health.hpp"

namespace cairn::app {
namespace {

constexpr double kMostAtTheTop = 0.5;  // share of the pixels

std::string size_of(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

Result<void> check_size(const Image& picture, const PictureForm& form) {
  if (picture.width == form.width && picture.height == form.height) return {};
  return Error{Errc::kMalformed,
               "a picture of another size than its intrinsics are of",
               {},
               {},
               size_of(picture.width, picture.height) + ", not " + size_of(form.width, form.height)};
}

/// What was looked at already tells nothing new: of a frozen picture, not one more counts.
Result<void> check_new(safety::StuckWatch& stuck, std::span<const std::byte> bytes) {
  stuck.step(0, bytes);
  if (!stuck.repeats()) return {};
  return Error{Errc::kMalformed, "the camera is stuck: the same picture again and again", {}, {}, {}};
}

template <class Value>
double share_at_the_top(const Image& values) {
  Value top = std::numeric_limits<Value>::lowest();
  std::size_t count = 0, all = 0;
  for (std::size_t at = 0; at + sizeof(Value) <= values.bytes.size(); at += sizeof(Value), ++all) {
    Value value{};
    std::memcpy(&value, values.bytes.data() + at, sizeof value);
    if (value > top) count = 0;
    top = std::max(top, value);
    if (value == top) ++count;
  }
  return all == 0 ? 1 : static_cast<double>(count) / static_cast<double>(all);
}

/// Noise makes the values of pixels differ, but for those at the end of the sensor's range.
Result<void> check_range(const ThermalImage& image) {
  const Image& values = image.values;
  const double top = image.radiometric() ? share_at_the_top<float>(values) : share_at_the_top<std::uint16_t>(values);
  if (top <= kMostAtTheTop) return {};
  return Error{Errc::kMalformed, "not looked at", {}, {}, "the thermal picture is overexposed, or has no contrast"};
}

}  // namespace

Result<const Image*> ColourReader::decode(const Packet& packet) {
  const auto decoded = camera_.decode(packet);
  if (!decoded || !form_.side_by_side) return decoded;
  if (const auto cut = camera::left_eye(**decoded, left_); !cut) return cut.error();
  return &left_;
}

/// A network has an answer for every picture, also for those on which nothing can be seen.
Result<const Image*> ColourReader::read(const Packet& packet) {
  const auto picture = decode(packet);
  if (!picture) return picture;
  if (const auto fits = check_size(**picture, form_); !fits) return fits.error();
  if (!form_.judged) return picture;
  if (const auto fresh = check_new(stuck_, packet.payload()); !fresh) return fresh.error();
  const health::PictureState state = health::judge(health::figures_of((*picture)->view()));
  if (state == health::PictureState::kGood) return picture;
  return Error{Errc::kMalformed, "not looked at", {}, {}, std::string(to_string(state))};
}

Result<const Image*> ThermalReader::read(const Packet& packet) {
  const auto frame = camera_.decode(packet);
  if (!frame) return frame.error();
  if (*frame == nullptr || (*frame)->correcting) return static_cast<const Image*>(nullptr);
  const Image& picture = (*frame)->stretched;
  if (const auto fits = check_size(picture, form_); !fits) return fits.error();
  if (!form_.judged) return &picture;
  if (const auto fresh = check_new(stuck_, picture.bytes); !fresh) return fresh.error();
  if (const auto fits = check_range(**frame); !fits) return fits.error();
  return &picture;
}

}  // namespace cairn::app
