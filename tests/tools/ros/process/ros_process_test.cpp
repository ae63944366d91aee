// SPDX-License-Identifier: Apache-2.0
// cairn-ros as programs of ROS discover it, and what it does when it or the core ends.
#include <gmock/gmock.h>
#include <graph.h>
#include <graph_humble.h>

#include <algorithm>

#include "tests/tools/ros/process/cyclone.hpp"
#include "tests/tools/ros/process/ros_rig.hpp"
#include "tools/ros/dds/ros_graph.hpp"
#include "tools/ros/messages/header.hpp"

namespace cairn::ros {
namespace {

using clients::Command;

class RosProcessTest : public RosRig {
 protected:
  RosProcessTest() : network_(domain_number()) {}

  void start_both(std::vector<std::string> more = {}) {
    commands_too(more);
    start_core();
    start_ros(more);
  }
  /// A pose comes through.
  bool odometry_comes(dds_entity_t reader) {
    return until([&] { return take_one<Odometry>(reader, [](const Odometry&) {}); });
  }

  CycloneRos network_;
};

Endpoint endpoint_of(const char* type, const RosType& ros, dds_durability_kind_t durability, bool reliable = true) {
  return {.type = type,
          .user_data = std::string("typehash=") + ros.hash + ";",
          .reliability = reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
          .durability = durability,
          .plain_cdr_alone = true};
}

TEST_F(RosProcessTest, WritersAreThoseOfRos) {
  constexpr auto kVolatile = DDS_DURABILITY_VOLATILE, kLatched = DDS_DURABILITY_TRANSIENT_LOCAL;
  const Endpoints expected{
      {"rt/husky_1/odom", endpoint_of("nav_msgs::msg::dds_::Odometry_", ros_type<Odometry>(), kVolatile)},
      {"rt/tf", endpoint_of("tf2_msgs::msg::dds_::TFMessage_", ros_type<TfMessage>(), kVolatile)},
      {"rt/tf_static", endpoint_of("tf2_msgs::msg::dds_::TFMessage_", ros_type<TfMessage>(), kLatched)},
      {"rt/husky_1/thermal_points",
       endpoint_of("sensor_msgs::msg::dds_::PointCloud2_", ros_type<PointCloud2>(), kVolatile)},
      {"rt/husky_1/points", endpoint_of("sensor_msgs::msg::dds_::PointCloud2_", ros_type<PointCloud2>(), kVolatile)},
      {"rt/diagnostics",
       endpoint_of("diagnostic_msgs::msg::dds_::DiagnosticArray_", ros_type<DiagnosticArray>(), kVolatile)},
      {"rt/husky_1/costmap", endpoint_of("nav_msgs::msg::dds_::OccupancyGrid_", ros_type<OccupancyGrid>(), kLatched)},
      {"rt/husky_1/people",
       endpoint_of("visualization_msgs::msg::dds_::MarkerArray_", ros_type<MarkerArray>(), kVolatile)},
      {"rt/husky_1/team_people",
       endpoint_of("visualization_msgs::msg::dds_::MarkerArray_", ros_type<MarkerArray>(), kVolatile)},
      {"rt/husky_1/joint_states",
       endpoint_of("sensor_msgs::msg::dds_::JointState_", ros_type<JointState>(), kVolatile)},
      {"rt/husky_1/front/image_raw/compressed",
       endpoint_of("sensor_msgs::msg::dds_::CompressedImage_", ros_type<CompressedImage>(), kVolatile)},
      {"rt/husky_1/front/camera_info",
       endpoint_of("sensor_msgs::msg::dds_::CameraInfo_", ros_type<CameraInfo>(), kVolatile)},
      {"rt/husky_1/map", endpoint_of("octomap_msgs::msg::dds_::Octomap_", ros_type<Octomap>(), kLatched)},
      {"rt/husky_1/team_map", endpoint_of("octomap_msgs::msg::dds_::Octomap_", ros_type<Octomap>(), kLatched)}};
  start_both();
  ASSERT_TRUE(until([&] { return network_.writers().size() >= expected.size(); }));
  for (const auto& [topic, endpoint] : network_.writers()) {
    ASSERT_TRUE(expected.contains(topic)) << topic;
    EXPECT_EQ(endpoint, expected.at(topic)) << topic << ": " << endpoint.type << ' ' << endpoint.user_data;
  }
  EXPECT_EQ(network_.participant_data(), "enclave=/;");
}

TEST_F(RosProcessTest, ReadersTakeWhatAnyWriterOfRosOffers) {
  constexpr auto kVolatile = DDS_DURABILITY_VOLATILE;
  const Endpoints expected{
      {"rt/husky_1/cmd_vel", endpoint_of("geometry_msgs::msg::dds_::Twist_", ros_type<Twist>(), kVolatile, false)},
      {"rt/husky_1/cmd_vel_stamped",
       endpoint_of("geometry_msgs::msg::dds_::TwistStamped_", ros_type<TwistStamped>(), kVolatile, false)},
      {"rt/husky_1/initialpose", endpoint_of("geometry_msgs::msg::dds_::PoseWithCovarianceStamped_",
                                             ros_type<PoseWithCovarianceStamped>(), kVolatile)},
      {"rt/husky_1/arm", endpoint_of("std_msgs::msg::dds_::Bool_", ros_type<BoolMessage>(), kVolatile)},
      {"rt/husky_1/stop", endpoint_of("std_msgs::msg::dds_::Bool_", ros_type<BoolMessage>(), kVolatile)}};
  start_both();
  ASSERT_TRUE(until([&] { return network_.readers().size() >= expected.size(); }));
  for (const auto& [topic, endpoint] : network_.readers()) {
    ASSERT_TRUE(expected.contains(topic)) << topic;
    EXPECT_EQ(endpoint, expected.at(topic)) << topic;
  }
}

TEST_F(RosProcessTest, WithoutACommandSocketNobodyCanCommand) {
  start_core();
  start_ros();
  ASSERT_TRUE(until([&] { return network_.writers().contains("rt/husky_1/team_map"); }));
  EXPECT_TRUE(network_.readers().empty());
}

/// A planner whose clock or network is late must not move the robot.
TEST_F(RosProcessTest, AStampedVelocityMovesTheRobotOnlyIfItIsFresh) {
  start_both();
  const dds_entity_t writer = network_.writer("rt/husky_1/cmd_vel_stamped", ros_type<TwistStamped>());
  Arena arena;
  TwistStamped twist{};
  const auto send = [&](Duration age, double v) {
    const Time now = LiveClock().now();
    twist.header = header_of(now, LiveClock::realtime_offset() - age, "base_link", arena);
    twist.twist.linear.x = v;
    dds_write(writer, &twist);
  };
  ASSERT_TRUE(until([&] {
    send(std::chrono::seconds(1), 0.9);
    send(-std::chrono::seconds(1), 0.8);
    send({}, 0.25);
    return std::ranges::count(core->commands, Command::Verb::kVelocity, &Command::verb) > 3;
  }));
  for (const Command& command : core->commands) EXPECT_EQ(command.v, 0.25);
}

TEST_F(RosProcessTest, ABoolArmsDisarmsAndStops) {
  start_both();
  const dds_entity_t arm = network_.writer("rt/husky_1/arm", ros_type<BoolMessage>());
  const dds_entity_t stop = network_.writer("rt/husky_1/stop", ros_type<BoolMessage>());
  const auto leads_to = [&](dds_entity_t writer, bool value, Command::Verb verb) {
    core->commands.clear();
    const BoolMessage message{value};
    return until([&] {
      dds_write(writer, &message);
      return std::ranges::count(core->commands, verb, &Command::verb) > 0;
    });
  };
  EXPECT_TRUE(leads_to(arm, true, Command::Verb::kArm));
  EXPECT_TRUE(leads_to(arm, false, Command::Verb::kDisarm));
  EXPECT_TRUE(leads_to(stop, true, Command::Verb::kStop));
  EXPECT_TRUE(leads_to(arm, true, Command::Verb::kArm));
}

TEST_F(RosProcessTest, APoseEstimateOfRvizPlacesTheRobot) {
  start_both();
  const dds_entity_t writer = network_.writer("rt/husky_1/initialpose", ros_type<PoseWithCovarianceStamped>());
  Arena arena;
  PoseWithCovarianceStamped pose{};
  pose.header = header_of(LiveClock().now(), LiveClock::realtime_offset(), "husky_2/odom", arena);
  pose.pose.pose.position = {3, -4, 0};
  pose.pose.pose.orientation.z = 1;
  ASSERT_TRUE(until([&] {
    dds_write(writer, &pose);
    return std::ranges::count(core->commands, Command::Verb::kPlace, &Command::verb) > 0;
  }));
  const clients::Placement& place = std::ranges::find(core->commands, Command::Verb::kPlace, &Command::verb)->place;
  EXPECT_EQ(place.frame.view(), "husky_2");
  EXPECT_EQ(place.x, 3);
  EXPECT_EQ(place.y, -4);
  EXPECT_NEAR(place.yaw, M_PI, 1e-9);
}

TEST_F(RosProcessTest, ItMayBeKilledAndComeBack) {
  start_both();
  const dds_entity_t reader = network_.reader("rt/husky_1/odom", ros_type<Odometry>());
  EXPECT_TRUE(odometry_comes(reader));
  for (int i = 0; i < 3; ++i) {
    ros->end(SIGKILL);
    std::vector<std::string> words;
    commands_too(words);
    start_ros(words);
    while (take_one<Odometry>(reader, [](const Odometry&) {})) {
    }
    EXPECT_TRUE(odometry_comes(reader));
  }
  EXPECT_EQ(ros->end(SIGTERM), 0);
}

TEST_F(RosProcessTest, TheCoreMayEndAndComeBack) {
  start_both();
  const dds_entity_t reader = network_.reader("rt/husky_1/odom", ros_type<Odometry>());
  const dds_entity_t cmd_vel = network_.writer("rt/husky_1/cmd_vel", ros_type<Twist>());
  const Twist twist{};
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(odometry_comes(reader));
    EXPECT_TRUE(until([&] {
      dds_write(cmd_vel, &twist);
      return !core->commands.empty();
    }));
    core.reset();
    while (take_one<Odometry>(reader, [](const Odometry&) {})) {
    }
    start_core();
  }
}

template <class Message>
void expect_node(const Message& said, std::size_t gid_size, std::size_t writers, std::size_t readers) {
  ASSERT_EQ(said.node_entities_info_seq._length, 1U);
  const auto& node = said.node_entities_info_seq._buffer[0];
  EXPECT_STREQ(node.node_name, "cairn_ros");
  EXPECT_STREQ(node.node_namespace, "/husky_1");
  EXPECT_EQ(node.writer_gid_seq._length, writers);
  EXPECT_EQ(node.reader_gid_seq._length, readers);
  EXPECT_EQ(sizeof said.gid.data, gid_size);
  EXPECT_TRUE(std::ranges::any_of(said.gid.data, [](auto byte) { return byte != 0; }));
}

template <class Message>
class RosNodeTest : public RosProcessTest {
 protected:
  static constexpr unsigned kWriters = 14;  // those of WritersAreThoseOfRos

  /// What the program says once it has the team's map, which comes with the first greeting.
  void expect_said(const char* form, GraphForm type, std::size_t gid_size) {
    start_both({"--graph", form});
    const dds_entity_t reader = network_.reader("ros_discovery_info", graph_type(type), true);
    bool complete = false;
    EXPECT_TRUE(until([&] {
      take_one<Message>(reader, [&](const Message& said) {
        complete = said.node_entities_info_seq._buffer[0].writer_gid_seq._length == kWriters;
        if (complete) expect_node(said, gid_size, kWriters, 5);
      });
      return complete;
    }));
  }
};

using IronNodeTest = RosNodeTest<rmw_dds_common_msg_dds__ParticipantEntitiesInfo_>;
using HumbleNodeTest = RosNodeTest<rmw_dds_common_humble_msg_dds__ParticipantEntitiesInfo_>;

TEST_F(IronNodeTest, IsSeenByNodes) { expect_said("iron", GraphForm::kIron, 16); }
TEST_F(HumbleNodeTest, IsSeenByNodes) { expect_said("humble", GraphForm::kHumble, 24); }

TEST(RosOptions, WrongOnesAreRefused) {
  EXPECT_EQ(RosProcess({"--namespace", "1a"}).wait(), 2);
  EXPECT_EQ(RosProcess({"--tree", "color", "--map", "binary"}).wait(), 2);
  EXPECT_EQ(RosProcess({"--graph", "jazzy"}).wait(), 2);
  EXPECT_EQ(RosProcess({"--pose-rate", "1000"}).wait(), 2);
  EXPECT_EQ(RosProcess({"--namespace", "a", "--interface", "no_such_one"}).wait(), 1);
  EXPECT_EQ(RosProcess({"--help"}).wait(), 0);
}

}  // namespace
}  // namespace cairn::ros
