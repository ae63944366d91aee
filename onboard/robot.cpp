// SPDX-License-Identifier: Apache-2.0
#include "onboard/robot.hpp"

#include <algorithm>
#include <utility>

namespace cairn {
namespace {

constexpr double kMoversFrom = 0.3, kMoversTo = 2.2;  // m above base_link: there things come and go

/// Of overload: the first of so many, in order.
void keep_every(int stride, std::vector<Eigen::Vector3f>& points) {
  if (stride <= 1) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); i += static_cast<std::size_t>(stride)) points[kept++] = points[i];
  points.resize(kept);
}

}  // namespace

Robot::Robot(const RobotConfig& config, Workers& odometry_workers, Workers& mapping_workers, Monitor& monitor)
    : mapper_(config.mapping, mapping_workers),
      monitor_(monitor),
      odometry_stage_(monitor.stage("odometry")),
      mapping_stage_(monitor.stage("mapping")) {
  set_up_odometry(config, odometry_workers);
  set_up_cameras(config);
}

Robot::Robot(const RobotConfig& config, Workers& odometry_workers, Workers& mapping_workers, Monitor& monitor,
             const Resume& saved)
    : mapper_(config.mapping, mapping_workers, saved.map),
      monitor_(monitor),
      odometry_stage_(monitor.stage("odometry")),
      mapping_stage_(monitor.stage("mapping")) {
  set_up_odometry(config, odometry_workers);
  set_up_cameras(config);
  if (lidar_) lidar_->resume(saved.T_odom_base, saved.twist, saved.stamp, saved.scans);
  if (eyes_) eyes_->resume(saved.T_odom_base, saved.twist, saved.stamp, saved.keyframes);
  LocatedScan located;
  for (const odometry::PlacedScan& scan : saved.scans) {
    if (scan.stamp <= saved.map_stamp) continue;
    located.stamp = scan.stamp;
    located.T_odom_base.mean = scan.T_odom_base;
    located.points_base = scan.points_base;
    if (const auto extended = extend_map(located); !extended)
      monitor.event(scan.stamp, "mapping", to_string(extended.error()));
  }
}

void Robot::set_up_odometry(const RobotConfig& config, Workers& workers) {
  if (const auto& stereo = config.stereo) {
    trust_ = stereo->trust;
    T_base_sensor_ = stereo->T_base_camera;
    eyes_.emplace(stereo->odometry, stereo->geometry, stereo->T_base_camera * cameras::T_camera_optical());
  } else {
    T_base_sensor_ = config.T_base_lidar;
    lidar_.emplace(config.odometry, config.T_base_lidar, workers);
    lidar_maps_ = config.lidar_maps;
  }
}

const odometry::MotionSource& Robot::odometry() const {
  if (eyes_) return *eyes_;
  return *lidar_;
}

void Robot::set_up_cameras(const RobotConfig& config) {
  depth_ = config.depth;
  if (const auto& setup = config.labelling) labeller_.emplace(setup->camera, setup->T_base_camera, setup->config);
  if (!config.people) return;
  people_.emplace(config.people->config);
  for (const PeopleSetup::MountedEye& eye : config.people->eyes)
    people_->set_eye(eye.eye, eye.camera, eye.T_base_camera);
  recent_ = labelling::LocatedScans({.age = people::Track::kMemory});
  people_by_depth_ = config.people->by_depth;
  if (people_by_depth_) clouds_ = labelling::LocatedScans({.age = people::Track::kMemory});
}

Result<TrackPoint> Robot::locate(const Scan& scan, Budget& budget, LocatedScan& located, const DriveState* wheels) {
  if (!lidar_) return Error{Errc::kUnsupported, "a scan came, but both eyes tell this robot's motion", {}, {}, {}};
  const StageTimer timing(odometry_stage_);
  const bool resuming = lidar_->resuming();
  const auto motion = lidar_->update(scan, budget, wheels);
  if (!motion) return motion.error();
  if (motion->lost) monitor_.event(motion->stamp, "odometry", "lost: the scan does not fit the map of the recent past");
  located.points_base.assign(motion->points_base.begin(), motion->points_base.end());
  return place(*motion, resuming, located);
}

Result<TrackPoint> Robot::locate(const stereo::StereoPair& pair, Budget& budget, LocatedScan& located) {
  if (!eyes_) return Error{Errc::kUnsupported, "a stereo picture came, but a LiDAR tells the motion", {}, {}, {}};
  const StageTimer timing(odometry_stage_);
  const bool resuming = eyes_->resuming();
  const auto motion = eyes_->update(pair, budget);
  if (!motion) return motion.error();
  if (motion->lost) monitor_.event(motion->stamp, "odometry", "lost: the picture shows too few known places");
  located.points_base.clear();
  return place(*motion, resuming, located);
}

const TrackPoint& Robot::place(const odometry::MotionUpdate& motion, bool resuming, LocatedScan& located) {
  located.stamp = motion.stamp;
  located.T_odom_base = motion.T_odom_base;
  located.twist = motion.twist;
  if (motion.began || motion.apart()) ++epoch_;
  if (motion.apart() && !resuming)
    monitor_.event(motion.stamp, "odometry",
                   "a new map begins: how it lies to the one before is not known (kept as map-epoch-N.cairn)");
  if ((motion.began || motion.apart()) && resuming)
    monitor_.event(motion.stamp, "restart", "the robot is not where the saved map ends: it begins anew");
  if (motion.began || motion.apart()) T_odom_before_ = motion.T_odom_before;
  located.epoch = epoch_;
  located.T_odom_before = T_odom_before_;
  located.lost = motion.lost;
  track_.push_back({.stamp = motion.stamp,
                    .T_odom_base = motion.T_odom_base,
                    .twist = motion.twist,
                    .epoch = epoch_,
                    .degenerate_directions = motion.degenerate_directions,
                    .by_wheels = motion.by_wheels,
                    .wrong_wheel_scale = motion.wrong_wheel_scale,
                    .iterations = motion.iterations,
                    .lost = motion.lost});
  return track_.back();
}

void Robot::begin_map(const LocatedScan& first) {
  auto before = mapper_.begin_anew();
  map_began_.reset();
  if (people_) people_->clear();
  clouds_.clear();
  mates_.clear();
  const bool next = first.epoch == mapped_epoch_ + 1;
  earlier_.keep(std::exchange(mapped_epoch_, first.epoch), std::move(before),
                next ? first.T_odom_before : std::nullopt);
}

void Robot::announce(const LocatedScan& scan) {
  if (scan.lost) return;
  if (scan.epoch != mapped_epoch_) begin_map(scan);
  if (!map_began_) map_began_ = scan.stamp;
  remember(scan);
}

/// Nothing changes if it is remembered already.
void Robot::remember(const LocatedScan& scan) {
  if (labeller_ || depth_ || people_)
    (void)recent_.add(scan.stamp, scan.T_odom_base.mean, scan.twist, scan.epoch, scan.points_base);
}

Result<void> Robot::extend_map(const LocatedScan& scan, const MapShare& share) {
  if (scan.lost) return {};
  const StageTimer timing(mapping_stage_);
  if (scan.epoch != mapped_epoch_) begin_map(scan);
  const SE3& T_odom_base = scan.T_odom_base.mean;
  const Eigen::Matrix3f R = T_odom_base.rotation().cast<float>();
  const Eigen::Vector3f t = T_odom_base.translation().cast<float>();
  points_odom_.clear();
  if (lidar_maps_)
    for (const Eigen::Vector3f& p : scan.points_base) points_odom_.emplace_back(R * p + t);
  const Eigen::Vector3f origin_odom = (T_odom_base * T_base_sensor_.translation()).cast<float>();
  leave_mates_out(scan.stamp);
  if (people_by_depth_)
    leave_known_people_out(scan.stamp);
  else if (people_)
    leave_people_out(scan.stamp, origin_odom, static_cast<float>(T_base_sensor_.translation().z()));
  keep_every(share.every_point, points_odom_);
  const double base = T_odom_base.translation().z();
  const auto inserted =
      trust_ ? mapper_.insert(points_odom_, origin_odom, *trust_)
             : mapper_.insert(points_odom_, origin_odom, mapping::HeightBand{base + kMoversFrom, base + kMoversTo});
  if (!inserted) return inserted.error();
  cleared_voxels_ += inserted->cleared;
  if (!map_began_) map_began_ = scan.stamp;
  if (people_) take_back_new_people();  // of earlier scans: this one left them out already
  remember(scan);
  return {};
}

Result<std::optional<SE3>> Robot::T_odom_base_at(Time t) const {
  if (recent_.size() == 0 || recent_[recent_.size() - 1].stamp < t) return std::nullopt;
  if (t < recent_[0].stamp && !before_map(t))
    return Error{
        Errc::kNotFound, "the picture came too late, its scans have gone: it is left out of the map", {}, {}, {}};
  const auto T_odom_base = recent_.pose_at(t);
  if (!T_odom_base || recent_.nearest(t)->epoch != mapped_epoch_)
    return Error{Errc::kNotFound, "no scans around the picture: it is left out of the map", {}, {}, {}};
  return T_odom_base;
}

Result<std::optional<SE3>> Robot::extend_map(const DepthCloud& cloud) {
  if (!depth_) return Error{Errc::kUnsupported, "a depth cloud came, but none is to be mapped", {}, {}, {}};
  const auto T_odom_base = T_odom_base_at(cloud.stamp);
  if (!T_odom_base || !*T_odom_base) return T_odom_base;
  const StageTimer timing(monitor_.stage("depth_update"));
  const Eigen::Matrix3f R = (*T_odom_base)->rotation().cast<float>();
  const Eigen::Vector3f t = (*T_odom_base)->translation().cast<float>();
  const Eigen::Vector3f origin_odom = R * cloud.origin_base + t;
  points_odom_.clear();
  for (const Eigen::Vector3f& p : cloud.points_base) points_odom_.emplace_back(R * p + t);
  leave_mates_out(cloud.stamp);
  if (people_by_depth_)
    leave_people_out(cloud.stamp, origin_odom, cloud.origin_base.z());
  else if (people_)
    leave_known_people_out(cloud.stamp);
  const auto inserted = mapper_.insert(points_odom_, origin_odom, *depth_);
  if (!inserted) return inserted.error();
  if (people_by_depth_) keep_cloud(cloud, **T_odom_base);
  return T_odom_base;
}

Result<std::optional<mapping::LabelReport>> Robot::label_map(const LabelImage& labels) {
  if (!labeller_) return Error{Errc::kUnsupported, "labels came, but no calibrated camera is set up", {}, {}, {}};
  const auto T_odom_base = T_odom_base_at(labels.stamp);
  if (!T_odom_base) return T_odom_base.error();
  if (!*T_odom_base) return std::nullopt;
  const StageTimer timing(monitor_.stage("label_update"));
  const Vector6 twist = recent_.twist_at(labels.stamp).value_or(Vector6::Zero());
  const auto labelled =
      labeller_->label(labels, *recent_.nearest(labels.stamp), {**T_odom_base, twist}, labelled_points_);
  if (!labelled) return labelled.error();
  return mapper_.label(labelled_points_);
}

}  // namespace cairn
