// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/bridge/robot_topics.hpp"

#include <algorithm>
#include <utility>

#include "hal/clock.hpp"
#include "onboard/client/view/costmap.hpp"
#include "tools/ros/messages/costmap.hpp"
#include "tools/ros/messages/odometry.hpp"
#include "tools/ros/messages/people.hpp"
#include "tools/ros/messages/points.hpp"
#include "tools/ros/messages/wheels.hpp"

namespace cairn::ros {
namespace {

constexpr Duration kDiagnosticsPeriod = std::chrono::seconds(1);
constexpr Duration kCostmapPeriod = std::chrono::milliseconds(500);

}  // namespace

Result<std::unique_ptr<RobotTopics>> RobotTopics::open(RosParticipant& participant, TopicOptions options) {
  const std::string at = "/" + options.name + "/";
  const auto odom = Writer<Odometry>::open(participant, at + "odom", TopicUse::kEvent);
  const auto tf = Writer<TfMessage>::open(participant, "/tf", TopicUse::kTf);
  const auto tf_static = Writer<TfMessage>::open(participant, "/tf_static", TopicUse::kLatched);
  const auto points = Writer<PointCloud2>::open(participant, at + "points", TopicUse::kStream);
  const auto diagnostics = Writer<DiagnosticArray>::open(participant, "/diagnostics", TopicUse::kEvent);
  const auto costmap = Writer<OccupancyGrid>::open(participant, at + "costmap", TopicUse::kLatched);
  const auto people = Writer<MarkerArray>::open(participant, at + "people", TopicUse::kEvent);
  const auto team_people = Writer<MarkerArray>::open(participant, at + "team_people", TopicUse::kEvent);
  const auto joint_states = Writer<JointState>::open(participant, at + "joint_states", TopicUse::kEvent);
  const auto thermal_points = Writer<PointCloud2>::open(participant, at + "thermal_points", TopicUse::kStream);
  const auto map = MapFeed::open(participant, at + "map", clients::TileMap::kOwn, options.map, options.map_period);
  if (!odom) return odom.error();
  if (!tf) return tf.error();
  if (!tf_static) return tf_static.error();
  if (!points) return points.error();
  if (!diagnostics) return diagnostics.error();
  if (!costmap) return costmap.error();
  if (!people) return people.error();
  if (!team_people) return team_people.error();
  if (!joint_states) return joint_states.error();
  if (!thermal_points) return thermal_points.error();
  if (!map) return map.error();
  const Writers writers{*odom,    *tf,     *tf_static,   *points,       *diagnostics,
                        *costmap, *people, *team_people, *joint_states, *thermal_points};
  std::unique_ptr<RobotTopics> topics(new RobotTopics(participant, std::move(options), writers, *map));
  topics->utc_.greeted(LiveClock::realtime_offset(), LiveClock::realtime_offset());
  return topics;
}

Result<void> RobotTopics::take(const client::StreamMessage& message, Time now) {
  arena_.clear();
  health_.heard(now);
  return std::visit([this](const auto& one) { return write(one); }, message);
}

Result<void> RobotTopics::write(const client::HelloMessage& hello) {
  utc_.greeted(hello.realtime_offset, LiveClock::realtime_offset());
  health_.core_came();
  T_team_odom_.reset();
  T_odom_base_.reset();
  pose_.reset();  // another core may count its time anew
  sensors_ = hello.sensors;
  write_frames();
  own_.begin(hello);
  if (hello.robot_id != 0 && !team_) {
    const auto map = MapFeed::open(*participant_, "/" + options_.name + "/team_map", clients::TileMap::kTeam,
                                   options_.map, options_.map_period);
    if (!map) return map.error();
    team_.emplace(*map);
  }
  if (team_) team_->begin(hello);
  return {};
}

/// Poses of scans that come after later predictions are left out: ROS wants one line of time.
Result<void> RobotTopics::write(const client::PoseMessage& pose) {
  health_.take(pose);
  if (pose_ && pose.stamp <= *pose_) return {};
  pose_ = pose.stamp;
  T_odom_base_ = pose.T_odom_base.mean;
  (void)writers_.odom.write(odometry_of(pose, frames_, utc_.value(), arena_));
  (void)writers_.tf.write(tf_of(pose, T_team_odom_, frames_, utc_.value(), arena_));
  return {};
}

Result<void> RobotTopics::write(const client::StateMessage& state) {
  health_.take(state);
  T_team_odom_ = state.T_team_odom;
  return {};
}

Result<void> RobotTopics::write(const client::TilesMessage& tiles) {
  if (const auto taken = own_.take(tiles); !taken) return taken;
  return team_ ? team_->take(tiles) : Result<void>{};
}

Result<void> RobotTopics::write(const client::ScanMessage& scan) {
  (void)writers_.points.write(points_of(scan, frames_, utc_.value(), arena_));
  return {};
}

Result<void> RobotTopics::write(const client::ThermalMessage& cloud) {
  (void)writers_.thermal_points.write(points_of(cloud, frames_, utc_.value(), arena_));
  return {};
}

Result<void> RobotTopics::write(const client::EventMessage& event) {
  health_.take(event);
  return {};
}

Result<void> RobotTopics::write(const client::PeopleMessage& people) {
  const Header header = header_of(people.stamp, utc_.value(), frames_.odom, arena_);
  (void)(people.robot == 0 ? writers_.people : writers_.team_people).write(markers_of(people, header, arena_));
  return {};
}

/// Topics of a camera stay when another core has no such camera.
Result<void> RobotTopics::write(const client::CameraMessage& camera) {
  if (const auto known = cameras_.find(camera.camera); known != cameras_.end()) {
    known->second.describe(camera);
  } else {
    auto feed = CameraFeed::open(*participant_, "/" + options_.name + "/", camera);
    if (!feed) return feed.error();
    cameras_.emplace(camera.camera, std::move(*feed));
  }
  const auto mount = std::ranges::find(sensors_, camera.name, &clients::HelloMessage::Sensor::name);
  if (mount == sensors_.end()) return {};
  const std::string optical = optical_frame(Frames(), camera);
  std::erase_if(sensors_, [&](const auto& sensor) { return sensor.name == optical; });
  const SE3 T_base_camera =
      std::ranges::find(sensors_, camera.name, &clients::HelloMessage::Sensor::name)->T_base_sensor;
  sensors_.push_back({optical, T_base_camera * T_camera_optical()});
  write_frames();
  return {};
}

Result<void> RobotTopics::write(const client::PictureMessage& picture) {
  const auto camera = cameras_.find(picture.camera);
  return camera == cameras_.end() ? Result<void>{} : camera->second.take(picture, frames_, utc_.value(), arena_);
}

/// Nothing without a radius: joints have angles.
Result<void> RobotTopics::write(const client::WheelsMessage& wheels) {
  if (wheels.radius_m > 0) (void)writers_.joint_states.write(joint_state_of(wheels, frames_, utc_.value(), arena_));
  return {};
}

/// All of them in one message, each time, as ROS wants it.
void RobotTopics::write_frames() {
  (void)writers_.tf_static.write(tf_static_of(sensors_, frames_, LiveClock().now(), utc_.value(), arena_));
}

Result<void> RobotTopics::write(client::CoreGone /*gone*/) {
  health_.core_gone();
  diagnosed_.reset();  // say it now
  return {};
}

Result<void> RobotTopics::write(std::monostate /*nothing*/) { return {}; }

Result<void> RobotTopics::tick(Time now, const std::vector<Diagnosis>& others) {
  arena_.clear();
  utc_.follow(LiveClock::realtime_offset());
  if (!diagnosed_ || now - *diagnosed_ >= kDiagnosticsPeriod) write_diagnostics(now, others);
  if (!planned_ || now - *planned_ >= kCostmapPeriod) write_costmap(now);
  return write_maps(now);
}

/// What the robot has seen itself outranks its team's map.
void RobotTopics::write_costmap(Time now) {
  const client::MapMirror* own = own_.mirror();
  if (own == nullptr || !T_odom_base_ || !pose_ || !writers_.costmap.read_by_anybody()) return;
  planned_ = now;
  const client::PlannerView view(*own, team_ ? team_->mirror() : nullptr, T_team_odom_);
  const Header header = header_of(*pose_, utc_.value(), frames_.odom, arena_);
  (void)writers_.costmap.write(occupancy_grid_of(make_costmap(view, *T_odom_base_), header, arena_));
}

Result<void> RobotTopics::write_maps(Time now) {
  // The newest pose's time: a frame of then is known to all who listen to /tf.
  const Time stamp = pose_.value_or(now);
  const auto own = own_.tick(now, header_of(stamp, utc_.value(), frames_.odom, arena_), arena_);
  if (!own || !team_) return own;
  return team_->tick(now, header_of(stamp, utc_.value(), frames_.team, arena_), arena_);
}

void RobotTopics::write_diagnostics(Time now, const std::vector<Diagnosis>& others) {
  diagnosed_ = now;
  std::vector<Diagnosis> all = health_.diagnoses(now);
  all.push_back(traffic());
  all.insert(all.end(), others.begin(), others.end());
  (void)writers_.diagnostics.write(diagnostics_of(all, options_.name, now, utc_.value(), arena_));
}

Diagnosis RobotTopics::traffic() const {
  const auto& [odom, tf, tf_static, points, diagnostics, costmap, people, team_people, joint_states, thermal_points] =
      writers_;
  std::uint64_t lost = odom.lost() + tf.lost() + points.lost() + costmap.lost() + people.lost() + team_people.lost() +
                       joint_states.lost() + thermal_points.lost() + own_.writer().lost();
  std::uint64_t pictures = 0;
  for (const auto& [number, camera] : cameras_) {
    lost += camera.lost();
    pictures += camera.written();
  }
  Diagnosis traffic{.level = lost == 0 ? DiagnosticLevel::kOk : DiagnosticLevel::kWarn,
                    .name = "cairn-ros",
                    .message = lost == 0 ? "all was sent" : "readers do not keep up"};
  traffic.values = {{"odom", std::to_string(odom.written())},
                    {"points", std::to_string(points.written())},
                    {"map", std::to_string(own_.writer().written())},
                    {"pictures", std::to_string(pictures)},
                    {"lost", std::to_string(lost)}};
  return traffic;
}

client::SubscribeMessage RobotTopics::wants() const {
  using clients::Stream;
  client::SubscribeMessage wants;
  for (const Stream stream : {Stream::kPose, Stream::kState, Stream::kOwnTiles, Stream::kEvents, Stream::kCameras})
    wants.add(stream);
  if (team_) wants.add(Stream::kTeamTiles);
  if (writers_.points.read_by_anybody()) wants.add(Stream::kScan);
  if (writers_.thermal_points.read_by_anybody()) wants.add(Stream::kThermal);
  if (writers_.people.read_by_anybody()) wants.add(Stream::kPeople);
  if (writers_.team_people.read_by_anybody()) wants.add(Stream::kTeamPeople);
  if (writers_.joint_states.read_by_anybody()) wants.add(Stream::kWheels);
  if (std::ranges::any_of(cameras_, [](const auto& camera) { return camera.second.read_by_anybody(); }))
    wants.add(Stream::kPictures);
  wants.pose_hz = options_.pose_hz;
  wants.picture_hz = static_cast<float>(options_.picture_hz);
  wants.own = own_.resume();
  if (team_) wants.team = team_->resume();
  return wants;
}

}  // namespace cairn::ros
