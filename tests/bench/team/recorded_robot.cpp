// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/team/recorded_robot.hpp"

#include <algorithm>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include "drivers/recording/recording_reader.hpp"
#include "drivers/velodyne/lidar.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/perception/cameras/camera_model.hpp"
#include "onboard/perception/stereo/row_motion.hpp"

namespace cairn::bench {

namespace fs = std::filesystem;

std::vector<fs::path> recordings_of(const std::string& folders) {
  std::vector<fs::path> all;
  std::istringstream in(folders);
  for (std::string folder; std::getline(in, folder, ',');) {
    std::vector<fs::path> robots;
    for (const auto& entry : fs::directory_iterator(folder))
      if (fs::exists(entry.path() / recording::kIndexFile)) robots.push_back(entry.path());
    std::ranges::sort(robots);
    all.insert(all.end(), robots.begin(), robots.end());
  }
  return all;
}

RecordedRobot::RecordedRobot(const RobotConfig& robot, const team::TeamConfig& config, std::optional<Eyes> eyes)
    : team(config, config.id | std::uint64_t{1} << 32U),
      robot_(robot, workers_, workers_, monitor_),
      eyes_(std::move(eyes)) {}

Result<std::unique_ptr<RecordedRobot>> RecordedRobot::open(const fs::path& dir, const team::TeamConfig& config) {
  const auto recording = recording::load_recording(dir);
  if (!recording) return recording.error();
  auto truth = recording::read_tum(dir / "ground_truth.tum");
  if (!truth) return truth.error();
  auto robot = create(dir, *recording, config);
  if (!robot) return robot;
  const auto kind = (*robot)->eyes_ ? recording::kCamera : recording::kVelodyne;
  const auto entry = std::ranges::find(recording->sources, kind, &recording::SourceEntry::kind);
  if (entry == recording->sources.end() || truth->empty())
    return Error{Errc::kNotFound, "no LiDAR, no stereo camera or no true pose in the recording", dir.string()};
  const auto index = static_cast<std::size_t>(entry - recording->sources.begin());
  auto source = recording::open_recorded_source(dir, *recording, index);
  if (!source) return source.error();
  if (!(*robot)->eyes_) {
    velodyne::Config lidar;
    lidar.model = entry->model;
    auto decoder = velodyne::Lidar::create(lidar, static_cast<SourceId>(index), (*robot)->monitor_);
    if (!decoder) return decoder.error();
    (*robot)->decoder_ = *std::move(decoder);
  }
  (*robot)->source_ = *std::move(source);
  (*robot)->truth_ = *std::move(truth);
  (*robot)->start_ = (*robot)->truth_.front().stamp;
  return robot;
}

/// LiDARs have the settings of the defaults, stereo cameras those that the recording keeps.
Result<std::unique_ptr<RecordedRobot>> RecordedRobot::create(const fs::path& dir, const recording::Recording& recording,
                                                             const team::TeamConfig& config) {
  const auto chosen = app::choose_profile({}, dir);
  if (!chosen) return chosen.error();
  auto stereo = app::open_stereo(chosen->profile, recording.sources);
  if (!stereo) return stereo.error();
  app::RobotProfile profile = *stereo ? chosen->profile : app::RobotProfile();
  profile.mapping.resolution_m = config.resolution_m;
  RobotConfig robot = profile.robot();
  std::optional<Eyes> eyes;
  if (*stereo) {
    robot.stereo = (*stereo)->setup;
    eyes = Eyes{.stereo = **std::move(stereo), .map_period = from_seconds(1 / profile.stereo.map_rate_hz)};
  }
  const auto lidar = std::ranges::find(recording.sources, recording::kVelodyne, &recording::SourceEntry::kind);
  if (lidar != recording.sources.end()) robot.T_base_lidar = lidar->T_base_sensor();
  return std::unique_ptr<RecordedRobot>(new RecordedRobot(robot, config, std::move(eyes)));
}

Result<void> RecordedRobot::advance(Time now) {
  while (!ended_) {
    if (!pending_) {
      const auto poll = source_->next(packet_, {});
      if (!poll) return poll.error();
      ended_ = *poll == Poll::kEnd;
      if (*poll != Poll::kPacket) continue;
      pending_ = true;
    }
    if (packet_.arrival - start_ > now.time_since_epoch()) return {};
    pending_ = false;
    raw_bytes_ += packet_.bytes.size();
    if (eyes_)
      take_picture(now);
    else if (const auto scan = decoder_->decode(packet_); scan && *scan != nullptr)
      take_scan(**scan, now);
  }
  return {};
}

void RecordedRobot::take_scan(const Scan& scan, Time now) {
  Budget budget = Budget::steps(1000);
  if (robot_.locate(scan, budget, located_)) extend_map(now);
}

void RecordedRobot::take_picture(Time now) {
  const auto picture = eyes_->stereo.camera.decode(packet_);
  if (!picture || !eyes_->stereo.rectifier.rectify(**picture, pair_)) return;
  Budget budget = Budget::steps(1000);
  if (!robot_.locate(pair_, budget, located_) || located_.lost || located_.stamp < eyes_->next) return;
  eyes_->next = located_.stamp + eyes_->map_period;
  const StereoSetup& setup = eyes_->stereo.setup;
  eyes_->stereo.dense.measure(pair_, setup.trust.max_range_m, points_eye_);
  const SE3 T_base_eye = setup.T_base_camera * cameras::T_camera_optical();
  const Eigen::Matrix3f R = T_base_eye.rotation().cast<float>();
  const Eigen::Vector3f t = T_base_eye.translation().cast<float>();
  for (const Eigen::Vector3f& p : points_eye_) located_.points_base.emplace_back(R * p + t);
  stereo::hold_still(setup.geometry, located_.twist, points_eye_, located_.points_base);
  extend_map(now);
}

void RecordedRobot::extend_map(Time now) {
  drift_on(located_.T_odom_base.mean);
  located_.T_odom_base.mean = T_drift_ * located_.T_odom_base.mean;
  if (!robot_.extend_map(located_)) return;
  team.be_at(located_.T_odom_base);
  for (const mapping::TileKey tile : robot_.take_changed_tiles())
    team.observe(tile, mapping::read_tile(robot_.map(), tile), now);
}

void RecordedRobot::drift_on(const SE3& T_odom_base) {
  const Eigen::Vector3d step = T_odom_base.translation() - last_position_;
  last_position_ = T_odom_base.translation();
  if (step.norm() < 1e-9) return;
  // The map grows by what is too much of a step, and turns about the robot.
  const Eigen::Vector3d here = T_drift_ * T_odom_base.translation(), ahead = T_drift_.rotation() * step;
  const Eigen::AngleAxisd turn(drift_.yaw_per_metre * step.norm(), Eigen::Vector3d::UnitZ());
  const SE3 turned(Eigen::Quaterniond(turn), here - turn * here + drift_.scale * ahead);
  T_drift_ = turned * T_drift_;
}

SE3 RecordedRobot::T_odom_base() const { return T_drift_ * robot_.track().back().T_odom_base.mean; }

SE3 RecordedRobot::T_world_base() const {
  const TrackPoint& last = robot_.track().back();
  const auto next = std::ranges::lower_bound(truth_, last.stamp, {}, &recording::StampedPose::stamp);
  if (next == truth_.begin()) return next->pose;
  if (next == truth_.end()) return truth_.back().pose;
  const auto before = std::prev(next);
  const double f = to_seconds(last.stamp - before->stamp) / to_seconds(next->stamp - before->stamp);
  return {before->pose.quaternion().slerp(f, next->pose.quaternion()),
          (1 - f) * before->pose.translation() + f * next->pose.translation()};
}

const mapping::SemanticOcTree& RecordedRobot::finished_map() {
  Budget all = Budget::steps(std::numeric_limits<int>::max());
  while (!team.fuse(all)) continue;
  return team.map().map();
}

}  // namespace cairn::bench
