// SPDX-License-Identifier: Apache-2.0
#include "drivers/thermal/thermal.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "hal/bytes.hpp"

namespace cairn::thermal {
namespace {

ImageView rows_of(const camera::Frame& frame, std::uint32_t first, std::uint32_t count) {
  const std::size_t stride = frame.header.bytes_per_line;
  return {PixelFormat::kMono16, static_cast<int>(frame.header.width), static_cast<int>(count), stride,
          frame.payload.subspan(std::min(first * stride, frame.payload.size()))};
}

std::optional<Scale> scale_of(const std::string& units) {
  if (units == "centikelvin") return kCentikelvin;
  if (units == "decikelvin") return kDecikelvin;
  if (units == "optris") return kOptris;
  return std::nullopt;
}

}  // namespace

Result<Thermal> Thermal::create(const Config& config) {
  if (auto sound = check(config); !sound) return sound.error();
  return Thermal(config);
}

Thermal::Thermal(const Config& config)
    : config_(config),
      model_(find_model(config.model)),
      stretch_(config.stretch_percent[0] / 100, config.stretch_percent[1] / 100) {}

Result<const ThermalImage*> Thermal::decode(const Packet& packet) {
  const bool again = last_sequence_ && packet.sequence <= *last_sequence_;
  const auto fresh = again ? Result<bool>(false) : fill(packet);
  if (!fresh) {
    ++counters_.rejected;
    return fresh.error();
  }
  if (!*fresh) {
    ++counters_.repeated;
    return nullptr;
  }
  ++counters_.frames;
  counters_.correcting += image_.correcting ? 1 : 0;
  return &image_;
}

/// False for a frame that the camera has sent before.
Result<bool> Thermal::fill(const Packet& packet) {
  if (packet.truncated) return Error{Errc::kTruncated, "the frame was cut off on its way"};
  const auto frame = camera::parse_frame(packet.payload());
  if (!frame) return frame.error();
  ImageView counts;
  if (auto parted = split(*frame, counts); !parted) return parted.error();
  last_sequence_ = packet.sequence;
  if (telemetry_ && std::exchange(last_counter_, telemetry_->frame_counter) == telemetry_->frame_counter) return false;
  for (Image* image : {&image_.values, &image_.stretched}) {
    image->source = packet.source;
    image->sequence = packet.sequence;
    image->stamp = packet.arrival - from_seconds(config_.latency_ms * 1e-3);
    image->start_of_exposure = frame->header.start_of_exposure;
  }
  image_.correcting = is_correcting(image_.values.stamp);
  const auto known = scale();
  fill_values(counts, known);
  stretch_.apply(counts, known ? config_.min_span_c / known->per_count : config_.min_span_counts, image_.stretched);
  return true;
}

/// Parts the picture from the rows behind it, and reads those.
Result<void> Thermal::split(const camera::Frame& frame, ImageView& picture) {
  const camera::FrameHeader& h = frame.header;
  if (frame.info->format != camera::FrameFormat::kY16)
    return Error{Errc::kUnsupported, "thermal frames have to be Y16: other formats are pictures for people"};
  const bool any = model_->width == 0;
  const bool with_rows = !any && model_->rows > 0 && h.height == model_->height + model_->rows;
  if (!any && (h.width != model_->width || (h.height != model_->height && !with_rows)))
    return Error{Errc::kMalformed, "the frame has another size than the thermal camera's model", {}, 4, {}};
  picture = rows_of(frame, 0, with_rows ? model_->height : h.height);
  telemetry_.reset();
  if (!with_rows || !model_->lepton_telemetry) return {};
  return read_telemetry(rows_of(frame, model_->height, model_->rows));
}

Result<void> Thermal::read_telemetry(const ImageView& rows) {
  std::array<std::byte, std::size_t{2} * 320> words{};  // the longest: two lines of 160
  auto end = words.begin();
  for (int y = 0; y < rows.height; ++y) {
    const auto row = rows.row(y);
    end = std::copy(row.begin(), row.end(), end);
  }
  auto parsed = parse_lepton_telemetry(std::span(words.begin(), end));
  if (!parsed) return parsed.error();
  telemetry_ = *parsed;
  return {};
}

/// Never a made-up temperature: the camera's own word goes before the configuration's.
std::optional<Scale> Thermal::scale() const {
  if (config_.units == "counts") return std::nullopt;
  if (!telemetry_) return scale_of(config_.units);
  if (!telemetry_->tlinear || telemetry_->agc) return std::nullopt;
  return telemetry_->centikelvin ? kCentikelvin : kDecikelvin;
}

bool Thermal::is_correcting(Time stamp) {
  if (telemetry_) {
    const LeptonTelemetry& t = *telemetry_;
    const bool just_ended = t.flat_field == FlatField::kComplete && t.uptime >= t.last_correction &&
                            t.uptime - t.last_correction < kSettling;
    if (t.flat_field == FlatField::kImminent || t.flat_field == FlatField::kRunning) corrected_ = stamp;
    if (just_ended) return true;
  }
  return corrected_ && stamp >= *corrected_ && stamp - *corrected_ < kSettling;
}

void Thermal::fill_values(const ImageView& counts, const std::optional<Scale>& known) {
  Image& out = image_.values;
  out.resize(known ? PixelFormat::kCelsius : PixelFormat::kMono16, counts.width, counts.height);
  for (int y = 0; y < counts.height; ++y) {
    const auto row = counts.row(y);
    std::byte* to = out.bytes.data() + static_cast<std::size_t>(y) * out.stride;
    if (!known) {
      std::copy(row.begin(), row.end(), to);
      continue;
    }
    for (std::size_t at = 0; at < row.size(); at += 2, to += sizeof(float)) {
      const auto celsius = static_cast<float>(known->per_count * load_le<std::uint16_t>(row, at) + known->offset);
      std::memcpy(to, &celsius, sizeof celsius);
    }
  }
}

}  // namespace cairn::thermal
