// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/picture_reader.hpp"

#include <string>

#include "onboard/perception/health/picture_health.hpp"

namespace cairn::app {
namespace {

std::string size_of(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

Result<void> check_size(const Image& picture, const PictureForm& form) {
  if (picture.width == form.width && picture.height == form.height) return {};
  return Error{Errc::kMalformed,
               "a picture of another size than its intrinsics are of",
               {},
               {},
               size_of(picture.width, picture.height) + ", not " + size_of(form.width, form.height)};
}

Result<void> check_moving(safety::StuckWatch& stuck, const Packet& packet) {
  if (!stuck.step(packet.channel, packet.payload())) return {};
  return Error{Errc::kMalformed, "the camera is stuck: the same picture again and again", {}, {}, {}};
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
  if (const auto moves = check_moving(stuck_, packet); !moves) return moves.error();
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
  if (const auto moves = check_moving(stuck_, packet); !moves) return moves.error();
  return &picture;
}

}  // namespace cairn::app
