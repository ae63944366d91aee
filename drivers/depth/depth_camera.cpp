// SPDX-License-Identifier: Apache-2.0
#include "drivers/depth/depth_camera.hpp"

#include "hal/bytes.hpp"

namespace cairn::depth {

Result<DepthCamera> DepthCamera::create(const Config& config) {
  if (auto sound = check(config); !sound) return sound.error();
  return DepthCamera(config);
}

Result<camera::Frame> DepthCamera::check_packet(const Packet& packet) const {
  if (packet.truncated) return Error{Errc::kTruncated, "the frame was cut off on its way"};
  if (last_sequence_ && packet.sequence <= *last_sequence_)
    return Error{Errc::kMalformed, "a frame came twice or late"};
  auto frame = camera::parse_frame(packet.payload());
  if (!frame) return frame;
  const auto format = frame->info->format;
  if (format != camera::FrameFormat::kZ16 && format != camera::FrameFormat::kY16)
    return Error{Errc::kUnsupported, "depth frames have to be Z16 or Y16"};
  return frame;
}

Result<const Scan*> DepthCamera::decode(const Packet& packet) {
  const auto frame = check_packet(packet);
  if (!frame) {
    ++counters_.rejected;
    return frame.error();
  }
  const camera::FrameHeader& h = frame->header;
  if (left_.size() != h.width || up_.size() != h.height) prepare_rays(h.width, h.height);
  scan_.source = packet.source;
  const Time stamp = packet.arrival - from_seconds(config_.latency_ms * 1e-3);
  scan_.valid = {stamp, stamp};
  scan_.lost_packets = last_sequence_ ? static_cast<std::uint32_t>(packet.sequence - *last_sequence_ - 1) : 0;
  last_sequence_ = packet.sequence;
  scan_.cloud.clear();
  for (std::uint32_t v = 0; v < h.height; v += static_cast<std::uint32_t>(config_.step_px))
    add_row(frame->payload.subspan(std::size_t{v} * h.bytes_per_line, std::size_t{h.width} * 2), v);
  ++counters_.frames;
  return &scan_;
}

void DepthCamera::prepare_rays(std::uint32_t width, std::uint32_t height) {
  left_.resize(width);
  up_.resize(height);
  for (std::uint32_t u = 0; u < width; ++u) left_[u] = static_cast<float>((config_.cx - u) / config_.fx);
  for (std::uint32_t v = 0; v < height; ++v) up_[v] = static_cast<float>((config_.cy - v) / config_.fy);
}

void DepthCamera::add_row(std::span<const std::byte> row, std::uint32_t v) {
  for (std::size_t u = 0; u < left_.size(); u += static_cast<std::size_t>(config_.step_px)) {
    const auto count = load_le<std::uint16_t>(row, 2 * u);
    const double depth = config_.unit_m * count;
    if (count == 0) {
      ++counters_.invalid;
    } else if (depth < config_.min_depth_m || depth > config_.max_depth_m) {
      ++counters_.gated;
    } else {
      const auto x = static_cast<float>(depth);
      scan_.cloud.push_back({x, x * left_[u], x * up_[v]}, 0, 0, 0, ReturnType::kStrongest);
    }
  }
}

}  // namespace cairn::depth
