// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/clients/messages/record.hpp"

namespace cairn::clients {

/// A camera of the robot and how it sees: what the profile says. One for each camera, after a subscription.
struct CameraMessage {
  static constexpr RecordKind kKind = RecordKind::kCamera;
  static constexpr std::size_t kMaxText = 64;
  static constexpr std::uint8_t kMost = 8;  ///< cameras
  static constexpr std::uint32_t kMaxSide = 16384;

  /// How the lens bends rays.
  enum class Lens : std::uint8_t {
    kUnknown,      ///< not calibrated: all numbers are 0
    kRadTan,       ///< OpenCV's k1 k2 p1 p2 k3 k4 k5 k6
    kEquidistant,  ///< OpenCV's fisheye, k1 k2 k3 k4
  };

  std::uint8_t camera = 0;                ///< its number, below kMost; PicturePart has the same
  std::string name{};                     ///< as HelloMessage::sensors calls it
  std::uint32_t width = 0, height = 0;    ///< pixels of the picture of one eye, without rows of telemetry
  bool side_by_side = false;              ///< a picture holds both eyes; the left half is the left eye's
  Lens lens = Lens::kUnknown;             ///< of the left eye
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< pixels; the centre of the upper left pixel is (0, 0)
  std::array<double, 8> k{};
  double baseline_m = 0;  ///< from the left to the right eye; 0: not known, or one eye
};

/// Appends the body. It is: camera (1), lens (1), side by side (1), zero (1), width (4), height (4), fx fy cx cy (8
/// each), distortion (8 × 8), baseline (8), name (text).
void encode(const CameraMessage& message, std::vector<std::byte>& out);
/// Error kMalformed.
[[nodiscard]] Result<CameraMessage> decode_camera(std::span<const std::byte> body);

}  // namespace cairn::clients
