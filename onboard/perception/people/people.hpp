// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "hal/labels.hpp"
#include "hal/se3.hpp"
#include "onboard/perception/people/box_lifter.hpp"
#include "onboard/perception/people/cluster_finder.hpp"
#include "onboard/perception/people/eye_offset.hpp"
#include "onboard/perception/people/people_config.hpp"
#include "onboard/perception/people/scan_rays.hpp"
#include "onboard/perception/people/tracker.hpp"

namespace cairn::people {

/// The two kinds of cameras that see people.
enum class Eye : std::uint8_t { kVisible, kThermal };

/// What a detector said of a body of the scan at `scan`.
struct Answered {
  Time scan{};
  Eye eye = Eye::kVisible;
  Eigen::Vector2f body{0, 0};  ///< its middle, odom, m
  float ground = 0;            ///< z of the ground there
  Answer answer;
};

/// A scan, in odom.
struct PeopleScan {
  Time stamp{};
  std::span<const Eigen::Vector3f> points_odom;           ///< m
  Eigen::Vector3f sensor_odom = Eigen::Vector3f::Zero();  ///< where the LiDAR is, m
  float sensor_height_m = 0;                              ///< above the ground
};

/// Finds and follows the people around one robot: scans and boxes in, tracks and masks out (book, chapter 6). Pure:
/// the same calls give the same result. Bounded in memory.
class People {
 public:
  /// What the map knows of a point's place.
  using Known = std::function<Space(const Eigen::Vector3f& point_odom)>;

  explicit People(const PeopleConfig& config);

  /// `T_base_camera`: the mount, in body axes.
  void set_eye(Eye eye, const cameras::CameraModel& camera, const SE3& T_base_camera);
  [[nodiscard]] bool has(Eye eye) const { return lifter(eye).has_value(); }

  /// A scan later than all before. Afterwards mask() says which of its points are people's.
  void observe(const PeopleScan& scan, const Known& known);
  /// What a detector saw in a picture, taken with base_link at `T_odom_base`. `scan`: the stamp of the scan nearest to
  /// the exposure. False: that scan is not remembered, or there is no such eye.
  bool hear(Eye eye, const Detections& boxes, Time scan, const SE3& T_odom_base);
  /// With `log_answers`: what the last hear() was told of each body in view; nothing if it was false.
  [[nodiscard]] std::span<const Answered> answered() const { return answered_; }
  /// Whether the camera's boxes are beside the people: then its silence about somebody counts for nothing.
  [[nodiscard]] const EyeOffset& offset(Eye eye) const { return offsets_[static_cast<std::size_t>(eye)]; }
  /// Another odom begins: everybody is forgotten.
  void clear();

  /// One for each point of the last scan: whether it is a person's. Valid until the next observe().
  [[nodiscard]] std::span<const std::uint8_t> mask() const { return mask_; }
  /// See Tracker.
  [[nodiscard]] std::span<const Person> people() const { return tracker_.people(); }
  [[nodiscard]] std::span<const Person> newcomers() const { return tracker_.newcomers(); }
  [[nodiscard]] std::vector<const Track*> take_new() { return tracker_.take_new(); }
  /// Whether a point of odom is within a body that stands at `position`.
  [[nodiscard]] bool in_body(const Eigen::Vector3f& point_odom, const Eigen::Vector2d& position, float ground) const;

 private:
  struct Remembered {
    Time stamp{};
    Eigen::Vector2d sensor{0, 0};  // odom
    std::vector<Cluster> bodies;
    std::vector<Eigen::Vector3f> loose;  // points that may be somebody's
  };
  static constexpr std::size_t kScans = 24;  // remembered
  [[nodiscard]] const std::optional<BoxLifter>& lifter(Eye e) const { return lifters_[static_cast<std::size_t>(e)]; }
  [[nodiscard]] std::optional<Tracker::Beside> look_for(const Eigen::Vector2d& position,
                                                        std::span<const Eigen::Vector2d> others,
                                                        const PeopleScan& scan);
  [[nodiscard]] static bool is_free(const Eigen::Vector2d& position, float ground, const Known& known);
  void ask_map(const PeopleScan& scan, const Known& known);
  void find_bodies(const PeopleScan& scan, std::span<const Eigen::Vector2d> seeds);
  void compare(Eye eye, const Detections& boxes, const Remembered& scan, const SE3& T_odom_base);
  void remember(const PeopleScan& scan, std::span<const Cluster> bodies);
  void note_answers(Eye eye, const Remembered& scan);
  [[nodiscard]] bool carried(const Track& track, const PeopleScan& scan) const;
  void doubt_furniture(const PeopleScan& scan);
  void fill_mask(const PeopleScan& scan);

  PeopleConfig config_;
  ClusterFinder finder_;
  ScanRays rays_;
  Tracker tracker_;
  std::array<std::optional<BoxLifter>, 2> lifters_;
  std::array<EyeOffset, 2> offsets_;
  std::deque<Remembered> scans_;
  std::vector<Space> spaces_;      // of the last scan's points
  std::vector<Cluster> clusters_;  // of the last scan
  std::vector<std::uint8_t> mask_;
  std::vector<std::uint32_t> furniture_;  // reused
  std::vector<BoxLifter::Known> known_;   // reused
  std::vector<Answer> answers_;           // reused
  std::vector<Answered> answered_;
};

}  // namespace cairn::people
