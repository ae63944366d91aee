// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "drivers/camera/frame.hpp"
#include "drivers/depth/config.hpp"
#include "hal/ports.hpp"

namespace cairn::depth {

/// 16-bit depth frames → points. Each frame is a whole scan at one instant, in metres in the sensor's REP-103 frame: x
/// along the optical axis, y to the left, z up (not the optical frame of REP 145). Pixels without a measurement (0) and
/// points outside the depth limits are left out. The intensity is 0 and the ring is not used.
class DepthCamera final : public ScanDecoder {
 public:
  /// What happened to the frames and pixels.
  struct Counters {
    std::uint64_t frames = 0;    ///< decoded
    std::uint64_t rejected = 0;  ///< malformed, repeated, or cut off by the transport
    std::uint64_t invalid = 0;   ///< pixels that were 0
    std::uint64_t gated = 0;     ///< pixels nearer or farther than configured
  };
  /// Error: kInvalidConfig.
  [[nodiscard]] static Result<DepthCamera> create(const Config& config);

  Result<const Scan*> decode(const Packet& packet) override;
  const Scan* expire(Time) override { return nullptr; }
  const Scan* flush() override { return nullptr; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  explicit DepthCamera(const Config& config) : config_(config) {}
  Result<camera::Frame> check_packet(const Packet& packet) const;
  void prepare_rays(std::uint32_t width, std::uint32_t height);
  void add_row(std::span<const std::byte> row, std::uint32_t v);

  Config config_;
  Scan scan_;
  std::vector<float> left_, up_;  // of each column and row, the ray's slope: y/x and z/x
  std::optional<std::uint64_t> last_sequence_;
  Counters counters_;
};

}  // namespace cairn::depth
