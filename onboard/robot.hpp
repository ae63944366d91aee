// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hal/budget.hpp"
#include "hal/drive.hpp"
#include "hal/labels.hpp"
#include "hal/monitor.hpp"
#include "hal/point_cloud.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/workers.hpp"
#include "onboard/earlier_maps.hpp"
#include "onboard/mapping/mapper.hpp"
#include "onboard/odometry/odometry.hpp"
#include "onboard/perception/cameras/camera_model.hpp"
#include "onboard/perception/labelling/located_scans.hpp"
#include "onboard/perception/labelling/point_labeller.hpp"
#include "onboard/perception/people/people.hpp"
#include "onboard/perception/stereo/stereo_geometry.hpp"
#include "onboard/perception/stereo/stereo_pair.hpp"
#include "onboard/visual_odometry/stereo_odometry.hpp"

namespace cairn {

/// The camera whose pictures label the map.
struct LabellingSetup {
  cameras::CameraModel camera;
  SE3 T_base_camera;  ///< how it is mounted, in body axes: x along its view, y left, z up
  labelling::LabellingConfig config;
};

/// The cameras that see people, and how people are followed.
struct PeopleSetup {
  /// One camera.
  struct MountedEye {
    people::Eye eye = people::Eye::kVisible;
    cameras::CameraModel camera;
    SE3 T_base_camera;  ///< how it is mounted, in body axes
  };
  people::PeopleConfig config;
  std::vector<MountedEye> eyes;
  bool by_depth = false;  ///< people are looked for in the clouds of a depth camera; otherwise in located scans
};

/// A robot without a LiDAR: both eyes of its camera tell its motion, and its map is made of what they see.
struct StereoSetup {
  visual_odometry::VisualOdometryConfig odometry;
  stereo::StereoGeometry geometry;
  SE3 T_base_camera;           ///< of the left eye, in body axes: x along its view, y left, z up
  mapping::SensorTrust trust;  ///< of the points of located scans
};

/// One robot: the pose of its LiDAR in base_link, and the settings of odometry and mapping.
struct RobotConfig {
  SE3 T_base_lidar;                   ///< how the LiDAR is mounted
  std::optional<StereoSetup> stereo;  ///< none: a LiDAR tells the motion
  odometry::OdometryConfig odometry;
  mapping::MappingConfig mapping;
  std::optional<LabellingSetup> labelling;    ///< none: the map gets no labels
  bool lidar_maps = true;                     ///< false: scans tell the motion alone, and the map gets none of them
  std::optional<mapping::SensorTrust> depth;  ///< none: the map gets no clouds of depth cameras
  std::optional<PeopleSetup> people;          ///< none: nobody is followed, and people stay in the map
};

/// Where the robot was when a scan ended, and how certain that is.
struct TrackPoint {
  Time stamp{};
  UncertainPose T_odom_base;
  Vector6 twist = Vector6::Zero();  ///< of base_link in base_link: m/s, rad/s
  std::uint32_t epoch = 0;        ///< counts maps; how the poses of two lie to each other is hardly known or not at all
  int degenerate_directions = 0;  ///< of the motion since the last scan: 0 = all six directions were observed
  bool by_wheels = false;         ///< along the others the wheels told it
  double wrong_wheel_scale = 0;   ///< see odometry::MotionUpdate
  int iterations = 0;
  bool lost = false;
};

/// A scan on its way into the map. It owns its points: neither the odometry nor the scan must
/// outlive it.
struct LocatedScan {
  Time stamp{};
  UncertainPose T_odom_base;
  Vector6 twist = Vector6::Zero();               ///< of base_link in base_link: m/s, rad/s
  std::vector<Eigen::Vector3f> points_base;      ///< deskewed, in base_link at `stamp`, in metres
  std::uint32_t epoch = 0;                       ///< see TrackPoint
  std::optional<UncertainPose> T_odom_before{};  ///< where that of the epoch before may lie: a guess
  bool lost = false;                             ///< the pose is only a prediction
};

/// What a depth camera saw at one instant.
struct DepthCloud {
  Time stamp{};                                           ///< of the exposure
  Eigen::Vector3f origin_base = Eigen::Vector3f::Zero();  ///< where the camera is
  std::vector<Eigen::Vector3f> points_base;               ///< in base_link at `stamp`, metres
};

/// A robot of the team that the LiDAR may see: an upright cylinder around its base_link.
struct Mate {
  Time stamp{};                                        ///< when it was there
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of its base_link, odom, m
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< odom, m/s
  double radius_m = 0, height_m = 0;                   ///< the top is above base_link
};

/// How much of a scan goes into the map; less under overload.
struct MapShare {
  int every_point = 1;  ///< 1: all points, 2: every second one, …
};

/// Where a restarted robot goes on. Its epoch stays 0; the first epoch of a robot that begins anew
/// is 1.
struct Resume {
  const mapping::SemanticOcTree& map;  ///< of the config's resolution; copied
  Time map_stamp{};                    ///< scans that are later go into the map again
  std::span<const odometry::PlacedScan> scans;
  UncertainPose T_odom_base;
  Vector6 twist = Vector6::Zero();
  Time stamp{};                                            ///< of the pose
  std::span<const visual_odometry::Keyframe> keyframes{};  ///< of a robot that both eyes tell its motion
};

/// One robot: scans and labels of pictures in, trajectory and map out. Deterministic for any number of threads.
/// locate() and extend_map() may run at the same time on two threads.
class Robot {
 public:
  /// The workers (one set for each of the two stages) and `monitor` are borrowed and must outlive
  /// the robot.
  Robot(const RobotConfig& config, Workers& odometry_workers, Workers& mapping_workers, Monitor& monitor);

  /// The same for a restarted robot. If it is not where the previous run ended, its first scan begins a new map;
  /// with eyes instead of a LiDAR, its pictures after a while.
  Robot(const RobotConfig& config, Workers& odometry_workers, Workers& mapping_workers, Monitor& monitor,
        const Resume& saved);

  /// Estimates the motion since the last scan; fills `located`, reusing its memory. `wheels`: their
  /// state at the scan's end, null where it is not known. On an error the scan is dropped, and the
  /// track is as before.
  Result<TrackPoint> locate(const Scan& scan, Budget& budget, LocatedScan& located, const DriveState* wheels = nullptr);
  /// The same by what both eyes see. `located` gets no points: they are for who measures them. Errors: kUnsupported
  /// (the robot has a LiDAR), and those of StereoOdometry::update().
  Result<TrackPoint> locate(const stereo::StereoPair& pair, Budget& budget, LocatedScan& located);
  /// Tells where the robot is at the scan that extend_map() gets next. So clouds up to it can come before it: people
  /// whom they show are no part of the map yet. Of extend_map()'s thread.
  void announce(const LocatedScan& scan);
  /// Adds a scan to the map, where its pose is trusted, but for the points of people. On an error (kLimit: the map's
  /// memory) the map is as before.
  Result<void> extend_map(const LocatedScan& scan, const MapShare& share = {});

  /// Adds what a depth camera saw, with the noise of RobotConfig::depth, but for the points of people. Returns where
  /// the robot was then; none while the scan after it is still to come. Of the other extend_map()'s thread. Errors:
  /// kNotFound (no scans around it, or the map of them has ended), kUnsupported (no RobotConfig::depth), and those of
  /// Mapper::insert().
  Result<std::optional<SE3>> extend_map(const DepthCloud& cloud);
  /// Labels the map by what a picture shows: the points of the scan nearest to the exposure, seen from where the camera
  /// was then. Nothing while the scan after the picture is still to come. Occupancy does not change. Of extend_map()'s
  /// thread. Errors: kNotFound (no scans around the picture, or the map of them has ended), kMalformed, kUnsupported
  /// (the robot has no LabellingSetup).
  Result<std::optional<mapping::LabelReport>> label_map(const LabelImage& labels);

  /// Whether the map has a scan, and `t` is before its first one. Of extend_map()'s thread.
  [[nodiscard]] bool before_map(Time t) const { return map_began_ && t < *map_began_; }
  /// Takes what a detector saw in a picture of `eye`. False while the scan after the picture is still to come, or the
  /// cloud in which people are looked for; that one is waited for 0.4 s of scans. Of extend_map()'s thread. Errors:
  /// kNotFound (no scans or clouds around the picture, or the map of them has ended), kUnsupported (the robot has no
  /// such eye).
  Result<bool> see_people(people::Eye eye, const Detections& boxes);
  /// The people around the robot at the last scan that extended the map, or the last cloud with by_depth. Of
  /// extend_map()'s thread.
  [[nodiscard]] std::span<const people::Person> people() const;
  /// See People.
  [[nodiscard]] std::span<const people::Answered> answered() const {
    return people_ ? people_->answered() : std::span<const people::Answered>();
  }
  /// How far the camera's boxes are beside the people, see people::EyeOffset; rad. None: too few were seen.
  [[nodiscard]] std::optional<double> eye_offset(people::Eye eye) const {
    return people_ ? people_->offset(eye).angle() : std::nullopt;
  }
  /// Where teammates are. Points on them stay out of the map, for kMateLife after `stamp`, and are no people. `epoch`:
  /// of the odom that they are in; of another than the map's, nothing is noted. Of extend_map()'s thread.
  void note_mates(std::span<const Mate> mates, std::uint32_t epoch);
  static constexpr Duration kMateLife = std::chrono::milliseconds(700);
  [[nodiscard]] bool follows_people() const { return people_.has_value(); }
  /// Whether it looks for them in the clouds of its depth camera.
  [[nodiscard]] bool follows_people_by_depth() const { return people_by_depth_; }

  /// The next scan decides whether the robot is where the previous run ended. Grant it every
  /// iteration.
  [[nodiscard]] bool resuming() const { return lidar_ && lidar_->resuming(); }
  /// Whether both eyes tell its motion, and no LiDAR.
  [[nodiscard]] bool sees_its_way() const { return eyes_.has_value(); }
  /// The keyframe that the last picture became; null: it became none. Of locate()'s thread.
  [[nodiscard]] const visual_odometry::Keyframe* new_keyframe() const {
    return eyes_ ? eyes_->new_keyframe() : nullptr;
  }

  [[nodiscard]] const std::vector<TrackPoint>& track() const { return track_; }
  /// Of locate()'s thread: pose and motion at the last scan, and the noise of a prediction from there.
  [[nodiscard]] const odometry::MotionFilter& motion() const { return odometry().motion(); }
  [[nodiscard]] odometry::MotionNoise expected_noise() const { return odometry().expected_noise(); }
  [[nodiscard]] const mapping::SemanticOcTree& map() const { return mapper_.tree(); }
  /// Voxels that something had entered and left, in all maps; see EnteredVoxels.
  [[nodiscard]] std::uint64_t cleared_voxels() const { return cleared_voxels_; }
  /// Of map(). It may lag behind the last TrackPoint's.
  [[nodiscard]] std::uint32_t map_epoch() const { return mapped_epoch_; }
  /// Maps of epochs that have ended. Of extend_map()'s thread.
  [[nodiscard]] const EarlierMaps& earlier_maps() const { return earlier_; }
  /// Adds to these tiles, in canonical order, what `moved` knows and map() does not: an earlier map in the frame of
  /// map(). Of extend_map()'s thread. Error kLimit: the map's memory.
  Result<void> fill_map(std::span<const mapping::TileKey> tiles, const mapping::SemanticOcTree& moved) {
    return mapper_.fill(tiles, moved);
  }
  /// All that the map of epoch `earlier` knows has been added to map(), in which it lies so. Of extend_map()'s thread.
  void note_joined(std::uint32_t earlier, const UncertainPose& T_map_earlier) {
    earlier_.join(earlier, mapped_epoch_, T_map_earlier);
  }
  [[nodiscard]] std::span<const mapping::TileKey> changed_tiles() const { return mapper_.changed_tiles(); }
  /// See Mapper::take_changed_tiles(). After a new epoch began, all of the map's.
  [[nodiscard]] std::vector<mapping::TileKey> take_changed_tiles() { return mapper_.take_changed_tiles(); }

 private:
  SE3 T_base_sensor_;  // of what measures the points of located scans
  std::optional<odometry::LidarOdometry> lidar_;
  std::optional<visual_odometry::StereoOdometry> eyes_;
  bool lidar_maps_ = true;                     // as RobotConfig has it
  std::optional<mapping::SensorTrust> trust_;  // of located scans; none: as the map's config has it
  mapping::Mapper mapper_;
  [[nodiscard]] const odometry::MotionSource& odometry() const;
  const TrackPoint& place(const odometry::MotionUpdate& motion, bool resuming, LocatedScan& located);
  void set_up_odometry(const RobotConfig& config, Workers& workers);
  void set_up_cameras(const RobotConfig& config);
  void begin_map(const LocatedScan& first);

  Monitor& monitor_;
  StageStats& odometry_stage_;
  StageStats& mapping_stage_;
  std::vector<TrackPoint> track_;
  std::uint32_t epoch_ = 0;  // odometry's
  std::optional<UncertainPose> T_odom_before_;
  std::uint32_t mapped_epoch_ = 0;  // mapping's: of the map
  std::optional<Time> map_began_;   // its first scan
  EarlierMaps earlier_;
  std::uint64_t cleared_voxels_ = 0;
  std::vector<Eigen::Vector3f> points_odom_;  // reused
  /// Where the robot was; nothing while the scan after `t` is still to come.
  [[nodiscard]] Result<std::optional<SE3>> T_odom_base_at(Time t) const;
  void remember(const LocatedScan& scan);
  void leave_mates_out(Time stamp);
  void leave_known_people_out(Time stamp);
  void leave_people_out(Time stamp, const Eigen::Vector3f& origin_odom, float mount_height);
  void take_back_new_people();
  void take_back(const labelling::PlacedScan* scan, const people::Step& body);
  void keep_cloud(const DepthCloud& cloud, const SE3& T_odom_base);
  [[nodiscard]] const labelling::LocatedScans& looked_at() const { return people_by_depth_ ? clouds_ : recent_; }
  [[nodiscard]] Result<const labelling::PlacedScan*> looked_at_around(Time t) const;
  std::vector<Mate> mates_;  // of the map's epoch
  std::optional<people::People> people_;
  bool people_by_depth_ = false;  // as PeopleSetup has it
  float height_ = 1;              // of eyes that fly, above the ground, m: where it was seen last
  std::optional<labelling::PointLabeller> labeller_;
  std::optional<mapping::SensorTrust> depth_;
  labelling::LocatedScans recent_;              // of mapping; empty where nothing needs it
  labelling::LocatedScans clouds_;              // the same, of clouds in which people are looked for
  std::vector<LabelledPoint> labelled_points_;  // reused
};

}  // namespace cairn
