// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "hal/labels.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "onboard/perception/cameras/camera_model.hpp"
#include "tools/cli/evaluate/people_file.hpp"
#include "tools/cli/evaluate/people_scene.hpp"

// Whom a robot without a LiDAR could see: the label pictures of a simulated recording say it.
namespace cairn::cli {

/// The pixels that make a person visible. Somebody who is whole has some 850 of them at 8 m with f = 350 pixels. This
/// is 15 % of that, the share that true_boxes.csv asks for.
inline constexpr std::uint32_t kVisiblePixels = 125;
inline constexpr double kPersonRadius_m = 0.25;  ///< of the upright cylinder in which the pixels of a person lie
inline constexpr double kPersonHeight_m = 1.9;   ///< of that cylinder: the simulator's people are 1.55 to 1.92 m tall

/// The height of the ground in a map without people, metres.
class Ground {
 public:
  /// `world` must outlive this.
  explicit Ground(const mapping::SemanticOcTree& world);

  /// The lower face of the lowest occupied voxel there; where there is none, of the lowest voxel of the map.
  [[nodiscard]] double at(const Eigen::Vector2d& position_world) const;

 private:
  const mapping::SemanticOcTree& world_;
  double lowest_, highest_;
};

/// Adds to Person::seen of each person the pixels of class person whose ray meets their cylinder, and none before it.
/// `model`: of pictures of the size of `labels`; `T_base_eye`: optical axes.
void count_pixels(const LabelImage& labels, const cameras::CameraModel& model, const SE3& T_base_eye,
                  const Ground& ground, PeopleScan& scan);

/// The stamps of the pictures in RECORDING/labels, in rising order. Error kNotFound: there is none.
[[nodiscard]] Result<std::vector<Time>> label_stamps(const std::filesystem::path& recording);

/// The pictures, of those at `stamps`, at which a run is judged that measures a cloud once in a `period` at most: each
/// that has rows of `tracks`, and one in a period where there are none for longer. So silence costs whoever is visible.
[[nodiscard]] std::vector<Time> judged_stamps(std::span<const Time> stamps, std::span<const PersonRow> tracks,
                                              Duration period);

/// Of each of the label pictures at `stamps`. The recording's ground_truth.tum and world.ot say where robot and ground
/// are. Errors: those of the files; kNotFound where `profile` does not say how the colour camera sees.
[[nodiscard]] Result<std::vector<PeopleScan>> people_pictures(const std::filesystem::path& recording,
                                                              const app::RobotProfile& profile,
                                                              std::span<const PersonRow> truth,
                                                              std::span<const Time> stamps);

}  // namespace cairn::cli
