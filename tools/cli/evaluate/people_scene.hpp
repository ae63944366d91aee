// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "tools/cli/evaluate/people_error.hpp"
#include "tools/cli/evaluate/people_file.hpp"

namespace cairn::cli {

/// Whether a source of the recording is of this kind.
[[nodiscard]] bool has(const recording::Recording& recording, recording::SensorKind kind);

/// What a camera sees, seen from above.
class ViewAngle {
 public:
  /// `T_base_camera`: body axes. `left`, `right`: angles from the view to the picture's edges, rad, left is positive.
  ViewAngle(const SE3& T_base_camera, double left, double right)
      : T_camera_base_(T_base_camera.inverse()), left_(left), right_(right) {}

  /// Whether the camera looks at this point of base_link, however high or far it is.
  [[nodiscard]] bool sees(const Eigen::Vector3d& point_base) const;

 private:
  SE3 T_camera_base_;
  double left_, right_;
};

/// The angles of the recording's calibrated cameras. `which`: camera, thermal or any. Errors: kNotFound where there is
/// none.
[[nodiscard]] Result<std::vector<ViewAngle>> view_angles(const std::filesystem::path& recording,
                                                         const app::RobotProfile& profile, const std::string& which);

inline constexpr std::uint32_t kVisibleReturns = 5;  ///< the LiDAR's returns that make a person visible

/// The people of a simulated recording at the time of a scan or of a picture, and how the robot saw them.
struct PeopleScan {
  struct Person {
    std::int64_t id = 0;
    Eigen::Vector2d position_world{0, 0};  ///< metres
    /// Returns of people less than kReturnsWithin_m from there, or the pixels that show this person.
    std::uint32_t seen = 0;
  };
  Time stamp{};
  SE3 T_world_base;
  std::vector<Person> people;
  std::optional<double> people_z{};              ///< of people's middles, in the world; none: as high as the robot
  std::uint32_t visible_from = kVisibleReturns;  ///< of Person::seen: who is seen so much is visible
};

inline constexpr Duration kSameScan = std::chrono::milliseconds(45);  ///< less than half a turn of the LiDAR
inline constexpr double kReturnsWithin_m = 0.5;                       ///< from above; a person is 0.5 m wide

/// Of each scan of the LiDAR. Errors: those of for_each_true_scan().
[[nodiscard]] Result<std::vector<PeopleScan>> people_scans(const std::filesystem::path& recording,
                                                           const app::RobotProfile& profile,
                                                           std::span<const PersonRow> truth);

/// Where the run's odom is in the world: the first common pose of both trajectories says so. `run` has trajectory.tum,
/// `recording` ground_truth.tum. Errors: those of the files; kMalformed where they have no common time.
[[nodiscard]] Result<SE3> place_of_odom(const std::filesystem::path& run, const std::filesystem::path& recording);

/// Where the middle of somebody is in the world, from above. `ground`: z below, odom. odom may be tilted.
[[nodiscard]] Eigen::Vector2d middle_in_world(const SE3& T_world_odom, const Eigen::Vector2d& position_odom,
                                              double ground);

/// Who counts: the people and tracks of a place that the robot can know.
struct PeopleZone {
  double within_m = 15;               ///< from the robot, from above
  std::span<const ViewAngle> angles;  ///< empty: all around
};

/// Tracks joined with the scans that they belong to.
struct JoinedPeople {
  std::vector<PeopleFrame> frames;  ///< one for each scan
  std::size_t without_scan = 0;     ///< rows of tracks at times without a scan
};
/// `tracks_world`: the run's rows, moved into the world.
[[nodiscard]] JoinedPeople join(std::span<const PeopleScan> scans, std::span<const PersonRow> tracks_world,
                                const PeopleZone& zone);

}  // namespace cairn::cli
