// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "onboard/client/robot_stream.hpp"
#include "tools/ros/bridge/camera_feed.hpp"
#include "tools/ros/bridge/map_feed.hpp"
#include "tools/ros/dds/topic.hpp"
#include "tools/ros/messages/diagnostics.hpp"
#include "tools/ros/messages/header.hpp"

namespace cairn::ros {

/// How a robot shows itself.
struct TopicOptions {
  std::string name;          ///< the namespace, without a slash before it
  std::string frame_prefix;  ///< before each frame but the team's
  MapForm map = MapForm::kBinary;
  Duration map_period = std::chrono::seconds(2);
  double pose_hz = 50;    ///< 0: the poses of scans alone
  double picture_hz = 5;  ///< of each camera, at most; 0: all
};

/// Out: what a core says, as topics of ROS.
class RobotTopics {
 public:
  /// Errors: kIo with what Cyclone DDS says. `participant` must outlive the topics.
  static Result<std::unique_ptr<RobotTopics>> open(RosParticipant& participant, TopicOptions options);

  /// What next() of a RobotStream found. Errors: kMalformed (a tile), kIo (a topic that a team needs).
  Result<void> take(const client::StreamMessage& message, Time now);
  /// Writes maps and, once a second, diagnostics, `others` after its own. Error kLimit: a map is too large.
  Result<void> tick(Time now, const std::vector<Diagnosis>& others);

  /// What the core should send now: scans, people, wheels and pictures only while somebody reads them.
  [[nodiscard]] client::SubscribeMessage wants() const;
  /// The epoch to arm with, as the core said last; none: it has not.
  [[nodiscard]] std::optional<std::uint32_t> arming_epoch() const { return health_.arming_epoch(); }

 private:
  struct Writers {
    Writer<Odometry> odom;
    Writer<TfMessage> tf, tf_static;
    Writer<PointCloud2> points;
    Writer<DiagnosticArray> diagnostics;
    Writer<OccupancyGrid> costmap;
    Writer<MarkerArray> people, team_people;
    Writer<JointState> joint_states;
    Writer<PointCloud2> thermal_points;
  };
  RobotTopics(RosParticipant& participant, TopicOptions options, Writers writers, MapFeed own)
      : participant_(&participant),
        options_(std::move(options)),
        frames_(options_.frame_prefix),
        writers_(writers),
        own_(std::move(own)) {}

  Result<void> write(const client::HelloMessage& hello);
  Result<void> write(const client::PoseMessage& pose);
  Result<void> write(const client::StateMessage& state);
  Result<void> write(const client::TilesMessage& tiles);
  Result<void> write(const client::ScanMessage& scan);
  Result<void> write(const client::ThermalMessage& cloud);
  Result<void> write(const client::EventMessage& event);
  Result<void> write(const client::PeopleMessage& people);
  Result<void> write(const client::CameraMessage& camera);
  Result<void> write(const client::PictureMessage& picture);
  Result<void> write(const client::WheelsMessage& wheels);
  Result<void> write(client::CoreGone gone);
  Result<void> write(std::monostate nothing);
  Result<void> write_maps(Time now);
  void write_frames();
  void write_costmap(Time now);
  void write_diagnostics(Time now, const std::vector<Diagnosis>& others);
  [[nodiscard]] Diagnosis traffic() const;

  RosParticipant* participant_;
  TopicOptions options_;
  Frames frames_;
  Writers writers_;
  MapFeed own_;
  std::optional<MapFeed> team_;
  std::map<std::uint8_t, CameraFeed> cameras_;  // by number
  std::vector<clients::HelloMessage::Sensor> sensors_;
  Health health_;
  UtcOffset utc_;
  std::optional<Time> pose_, diagnosed_;  // stamp of the newest pose written; of the last diagnostics
  std::optional<SE3> T_team_odom_, T_odom_base_;
  std::optional<Time> planned_;  // the last costmap
  Arena arena_;
};

}  // namespace cairn::ros
