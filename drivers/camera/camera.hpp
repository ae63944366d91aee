// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/camera/config.hpp"
#include "hal/ports.hpp"

namespace cairn::camera {

/// The two eyes of one picture. The views are valid as long as the picture.
struct StereoView {
  ImageView left, right;
};
/// The left half is the left eye's (stereolabs/zed-open-capture). Copies nothing. Error: kMalformed for an odd width.
[[nodiscard]] Result<StereoView> split_side_by_side(const ImageView& both);
/// Copies the left eye; `left` reuses its memory. Error: kMalformed for an odd width.
[[nodiscard]] Result<void> left_eye(const Image& both, Image& left);

/// Frames in packets (frame.hpp) → pictures. Refuses packets that come twice or are older than the last one.
class Camera final : public ImageDecoder {
 public:
  /// What happened to the packets.
  struct Counters {
    std::uint64_t frames = 0;    ///< decoded
    std::uint64_t rejected = 0;  ///< malformed, or cut off by the transport
    std::uint64_t repeated = 0;  ///< the sequence is not above the last one
    std::uint64_t lost = 0;      ///< gaps in the sequence
  };
  /// Error: kInvalidConfig.
  [[nodiscard]] static Result<Camera> create(const Config& config);

  Result<const Image*> decode(const Packet& packet) override;
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  explicit Camera(const Config& config) : latency_(from_seconds(config.latency_ms * 1e-3)) {}
  Result<void> fill(const Packet& packet);

  Duration latency_;
  Image image_;
  std::optional<std::uint64_t> last_sequence_;
  Counters counters_;
};

}  // namespace cairn::camera
