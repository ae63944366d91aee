// SPDX-License-Identifier: Apache-2.0
// Pictures for the recording of room_run.hpp: of every pixel it is known what it shows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/files/file.hpp"
#include "tests/onboard/app/perception/grey_png.hpp"
#include "tests/onboard/app/room_run.hpp"

namespace cairn::app::test {

inline constexpr int kEyeColumns = 96, kEyeRows = 72;
inline constexpr double kEyeFocal = 48;  // pixels
inline constexpr std::uint8_t kRoad = 0, kBuilding = 2, kWall = 3;
inline const Vector6 kCameraMount = (Vector6() << 0.3, 0, 0.5, 0, 0, 0).finished();

/// Floor, ceiling, and what stands between them.
inline std::uint8_t class_at(double z) { return z < 0.02 ? kRoad : z > 2.9 ? kBuilding : kWall; }

/// What a camera sees of a class: dark floors and light walls.
inline std::byte grey_of(std::uint8_t class_id) { return static_cast<std::byte>(30 + 50 * class_id); }

inline std::vector<std::byte> true_labels(const support::World& world, const SE3& T_world_camera) {
  std::vector<std::byte> labels;
  for (int v = 0; v < kEyeRows; ++v)
    for (int u = 0; u < kEyeColumns; ++u) {
      const Eigen::Vector3d ray(1, -(u - (kEyeColumns - 1) / 2.0) / kEyeFocal, -(v - (kEyeRows - 1) / 2.0) / kEyeFocal);
      const Eigen::Vector3d d = T_world_camera.rotation() * ray.normalized(), o = T_world_camera.translation();
      labels.push_back(static_cast<std::byte>(class_at((o + world.cast(o, d) * d).z())));
    }
  return labels;
}

/// Grey pictures at 10 Hz between the scans, with what they show in labels/.
inline void record_pictures(const fs::path& folder) {
  fs::create_directories(folder / "camera" / "data");
  fs::create_directories(folder / "labels");
  const support::World world = room();
  std::string index = "#timestamp [ns],filename\n";
  for (int i = 0; i < kScans - 1; ++i) {
    const Time t{from_seconds(0.1 * i + 0.13)};
    const std::string name = std::to_string(t.time_since_epoch().count()) + ".png";
    const auto labels = true_labels(world, path(to_seconds(t)) * SE3::from_xyz_rpy(kCameraMount));
    std::vector<std::byte> grey;
    for (const std::byte label : labels) grey.push_back(grey_of(std::to_integer<std::uint8_t>(label)));
    write_png(folder / "camera" / "data" / name, kEyeColumns, kEyeRows, grey);
    write_png(folder / "labels" / name, kEyeColumns, kEyeRows, labels);
    index += std::to_string(t.time_since_epoch().count()) + "," + name + "\n";
  }
  ASSERT_TRUE(write_file_atomic(folder / "camera" / "data.csv", index));
  auto recorded = recording::load_recording(folder).value();
  recorded.sources.push_back({"camera", recording::kCamera, "camera/data.csv", "camera", "", kCameraMount});
  ASSERT_TRUE(recording::save_recording(folder, recorded));
}

inline constexpr const char* kLabelledProfile = R"(
lidar: {T_base_lidar: [0.2, 0, 0.6, 0, 0, 0.1]}
camera:
  capture: {format: GREY, width: 96, height: 72}
  side_by_side: false
  T_base_camera: [0.3, 0, 0.5, 0, 0, 0]
  intrinsics: {fx: 48, fy: 48, cx: 47.5, cy: 35.5}
perception: {segmentation: {rate_hz: 20}}
)";

}  // namespace cairn::app::test
