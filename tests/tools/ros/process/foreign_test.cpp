// SPDX-License-Identifier: Apache-2.0
// cairn-ros beside a core, read and commanded by another vendor's DDS: each topic field by field.
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <array>
#include <cmath>
#include <cstring>
#include <sstream>

#include "onboard/client/view/costmap.hpp"
#include "tests/tools/ros/process/foreign_rig.hpp"
#include "tools/ros/messages/odometry.hpp"

namespace cairn::ros {
namespace {

TEST_F(ForeignRos, ReadsOdometry) {
  start_core();
  start_ros();
  for (const auto& qos : {fast::default_qos(), fast::sensor_qos()}) {
    auto payload = first("rt/husky_1/odom", "nav_msgs::msg::dds_::Odometry_", qos);
    ASSERT_TRUE(payload);
    Fields fields(*payload);
    expect_stamp(fields);
    EXPECT_EQ(fields.text(), "odom");
    EXPECT_EQ(fields.text(), "base_link");
    expect_transform(fields, pose().T_odom_base.mean);
    const Matrix6 covariance = covariance_in_header_frame(pose().T_odom_base);
    EXPECT_EQ(fields.reals(36), std::vector<double>(covariance.data(), covariance.data() + 36));
    EXPECT_EQ(fields.reals(6), (std::vector<double>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(fields.reals(36), std::vector<double>(36, 0.0));
  }
}

TEST_F(ForeignRos, ReadsTransforms) {
  start_core();
  start_ros({"--frame-prefix", "h1/"});
  auto* reader = ros_side_.reader("rt/tf", "tf2_msgs::msg::dds_::TFMessage_", fast::default_qos());
  std::optional<Payload> moving;
  EXPECT_TRUE(until([&] {
    moving = fast::take(reader);
    return moving && Fields(*moving).next<std::uint32_t>() == 2;
  })) << "the first may come before the core has said where the team's frame is";
  ASSERT_TRUE(moving);
  Fields tf(*moving);
  EXPECT_EQ(tf.next<std::uint32_t>(), 2U);
  expect_stamp(tf);
  EXPECT_EQ(tf.text(), "h1/odom");
  EXPECT_EQ(tf.text(), "h1/base_link");
  expect_transform(tf, pose().T_odom_base.mean);
  expect_stamp(tf);
  EXPECT_EQ(tf.text(), "team");
  EXPECT_EQ(tf.text(), "h1/odom");
  expect_transform(tf, *state().T_team_odom);

  auto* latched = ros_side_.reader("rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_", fast::latched_qos());
  std::optional<Payload> fixed;
  EXPECT_TRUE(until([&] {
    fixed = fast::take(latched);
    return fixed && Fields(*fixed).next<std::uint32_t>() == 3;
  })) << "the optical frame follows when the core has said its cameras";
  ASSERT_TRUE(fixed);
  Fields tf_static(*fixed);
  EXPECT_EQ(tf_static.next<std::uint32_t>(), 3U);
  auto sensors = hello().sensors;
  sensors.push_back({"front_optical", SE3(Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), Eigen::Vector3d::Zero())});
  for (const auto& sensor : sensors) {
    (void)tf_static.next<std::int32_t>();
    (void)tf_static.next<std::uint32_t>();
    EXPECT_EQ(tf_static.text(), "h1/base_link");
    EXPECT_EQ(tf_static.text(), "h1/" + sensor.name);
    expect_transform(tf_static, sensor.T_base_sensor);
  }
}

TEST_F(ForeignRos, ReadsPointsWhichAreAskedForOnlyThen) {
  start_core();
  start_ros();
  ASSERT_TRUE(until([&] { return core->subscription.has_value(); }));
  EXPECT_FALSE(core->subscription->wants(clients::Stream::kScan));
  auto payload = first("rt/husky_1/points", "sensor_msgs::msg::dds_::PointCloud2_", fast::sensor_qos());
  ASSERT_TRUE(payload);
  Fields fields(*payload);
  expect_stamp(fields);
  EXPECT_EQ(fields.text(), "base_link");
  EXPECT_EQ(fields.next<std::uint32_t>(), 1U);
  EXPECT_EQ(fields.next<std::uint32_t>(), points().size());
  EXPECT_EQ(fields.next<std::uint32_t>(), 3U);
  for (const auto& [name, offset] : {std::pair{"x", 0U}, std::pair{"y", 4U}, std::pair{"z", 8U}}) {
    EXPECT_EQ(fields.text(), name);
    EXPECT_EQ(fields.next<std::uint32_t>(), offset);
    EXPECT_EQ(fields.next<std::uint8_t>(), 7U);
    EXPECT_EQ(fields.next<std::uint32_t>(), 1U);
  }
  EXPECT_FALSE(fields.next<bool>());
  EXPECT_EQ(fields.next<std::uint32_t>(), 12U);
  EXPECT_EQ(fields.next<std::uint32_t>(), 12U * points().size());
  const auto data = fields.next<std::vector<std::uint8_t>>();
  ASSERT_EQ(data.size(), 12U * points().size());
  EXPECT_EQ(std::memcmp(data.data(), points().data(), data.size()), 0);
  EXPECT_TRUE(fields.next<bool>());
}

/// As octomap_msgs reads a message.
std::unique_ptr<octomap::OcTree> tree_of(Fields& fields, bool binary, const std::string& frame) {
  (void)fields.next<std::int32_t>();
  (void)fields.next<std::uint32_t>();
  EXPECT_EQ(fields.text(), frame);
  EXPECT_EQ(fields.next<bool>(), binary);
  EXPECT_EQ(fields.text(), "OcTree");
  auto tree = std::make_unique<octomap::OcTree>(fields.next<double>());
  const auto data = fields.next<std::vector<std::int8_t>>();
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data.data()), data.size()));
  if (binary)
    tree->readBinaryData(stream);
  else
    tree->readData(stream);
  return tree;
}

TEST_F(ForeignRos, ReadsMapsThatOctoMapUnderstands) {
  using clients::TileMap;
  for (const bool binary : {true, false}) {
    start_core();
    start_ros({"--map", binary ? "binary" : "full", "--map-period", "0.2"});
    for (const auto& [topic, which, frame] : {std::tuple{"rt/husky_1/map", TileMap::kOwn, "odom"},
                                              std::tuple{"rt/husky_1/team_map", TileMap::kTeam, "team"}}) {
      auto payload = first(topic, "octomap_msgs::msg::dds_::Octomap_", fast::latched_qos());
      ASSERT_TRUE(payload);
      Fields fields(*payload);
      const auto tree = tree_of(fields, binary, frame);
      EXPECT_EQ(tree->getResolution(), kResolution);
      mapping::SemanticOcTree expected(kResolution);
      mapping::write_tile(expected, place_of(which), wall());
      for (auto leaf = expected.begin_leafs(); leaf != expected.end_leafs(); ++leaf) {
        const auto* found = tree->search(leaf.getKey());
        ASSERT_NE(found, nullptr);
        EXPECT_EQ(tree->isNodeOccupied(found), expected.isNodeOccupied(*leaf));
        EXPECT_TRUE(binary || found->getLogOdds() == leaf->getLogOdds());
      }
      EXPECT_TRUE(binary || tree->size() == expected.size());
    }
  }
}

TEST_F(ForeignRos, ReadsACostmapOfWhatTheRobotSaw) {
  start_core();
  start_ros();
  client::MapMirror mirror(clients::TileMap::kOwn, kResolution), team(clients::TileMap::kTeam, kResolution);
  ASSERT_TRUE(mirror.take(tiles(clients::TileMap::kOwn)));
  ASSERT_TRUE(team.take(tiles(clients::TileMap::kTeam)));
  const client::PlannerView view(mirror, &team, state().T_team_odom);
  const client::Costmap expected = client::make_costmap(view, pose().T_odom_base.mean);
  auto* reader = ros_side_.reader("rt/husky_1/costmap", "nav_msgs::msg::dds_::OccupancyGrid_", fast::latched_qos());
  EXPECT_TRUE(until([&] {
    auto payload = fast::take(reader);
    if (!payload) return false;
    Fields fields(*payload);
    expect_stamp(fields);
    EXPECT_EQ(fields.text(), "odom");
    expect_stamp(fields);
    EXPECT_EQ(fields.next<float>(), static_cast<float>(kResolution));
    EXPECT_EQ(fields.next<std::uint32_t>(), static_cast<std::uint32_t>(expected.cells));
    EXPECT_EQ(fields.next<std::uint32_t>(), static_cast<std::uint32_t>(expected.cells));
    EXPECT_EQ(fields.reals(7), (std::vector<double>{expected.x_m, expected.y_m, 0, 0, 0, 0, 1}));
    const auto cells = fields.next<std::vector<std::int8_t>>();
    return cells == expected.occupancy_grid();  // the first may come before the maps do
  }));
}

/// One status of /diagnostics.
struct Status {
  std::uint8_t level = 0;
  std::string name, message, hardware;
  std::map<std::string, std::string> values;
};

std::map<std::string, Status> statuses_of(Payload& payload) {
  Fields fields(payload);
  (void)fields.next<std::int32_t>();
  (void)fields.next<std::uint32_t>();
  EXPECT_EQ(fields.text(), "");
  std::map<std::string, Status> all;
  for (auto left = fields.next<std::uint32_t>(); left > 0; --left) {
    Status status{.level = fields.next<std::uint8_t>(),
                  .name = fields.text(),
                  .message = fields.text(),
                  .hardware = fields.text(),
                  .values = {}};
    for (auto values = fields.next<std::uint32_t>(); values > 0; --values) {
      const std::string key = fields.text();
      status.values[key] = fields.text();
    }
    all[status.name] = status;
  }
  return all;
}

TEST_F(ForeignRos, ReadsDiagnosticsThatSayWhenTheCoreHasGone) {
  start_ros({"--namespace", "husky_1"});
  auto* reader =
      ros_side_.reader("rt/diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_", fast::default_qos());
  std::map<std::string, Status> said;
  const auto come = [&](std::uint8_t level) {
    return until([&] {
      auto payload = fast::take(reader);
      if (payload) said = statuses_of(*payload);
      return payload && said["husky_1: mode"].level == level;
    });
  };
  EXPECT_TRUE(come(3)) << "STALE: there is no core yet";
  start_core();
  EXPECT_TRUE(come(2)) << "ERROR: stopped by a fault";
  EXPECT_EQ(said["husky_1: mode"].message, "stop: estop");
  EXPECT_EQ(said["husky_1: mode"].hardware, "husky_1");
  EXPECT_EQ(said["husky_1: mode"].values["faults"], "estop lidar_silent");
  EXPECT_EQ(said["husky_1: core"].level, 0U);
  EXPECT_TRUE(until([&] {
    auto payload = fast::take(reader);
    if (payload) said = statuses_of(*payload);
    return said["husky_1: stage odometry"].values["scan refused"] == "2" && said["husky_1: odometry"].level == 0;
  }));
  core.reset();
  EXPECT_TRUE(come(3)) << "STALE: the core has gone";
  start_core();
  EXPECT_TRUE(come(2)) << "another one came";
}

TEST_F(ForeignRos, Commands) {
  using clients::Command;
  std::vector<std::string> words;
  commands_too(words);
  start_core();
  start_ros(words);
  auto* cmd_vel = ros_side_.writer("rt/husky_1/cmd_vel", "geometry_msgs::msg::dds_::Twist_");
  Payload twist = fast::payload_of(0.5, 0.0, 0.0, 0.0, 0.0, -0.25);
  const auto asked = [&](Command::Verb verb) {
    return std::ranges::find(core->commands, verb, &Command::verb) != core->commands.end();
  };
  ASSERT_TRUE(until([&] {
    cmd_vel->write(&twist);
    return asked(Command::Verb::kVelocity);
  }));
  const Command& first = core->commands.front();
  EXPECT_EQ(first.v, 0.5);
  EXPECT_EQ(first.w, -0.25);
  EXPECT_EQ(first.who.view(), "cairn-ros");
  EXPECT_GT(first.valid_for, Duration{});
  EXPECT_LE(first.valid_for, Command::kMostValid);

  auto* arm = ros_side_.writer("rt/husky_1/arm", "std_msgs::msg::dds_::Bool_");
  Payload yes = fast::payload_of(true);
  ASSERT_TRUE(until([&] {
    arm->write(&yes);
    return asked(Command::Verb::kArm);
  }));
  EXPECT_EQ(std::ranges::find(core->commands, Command::Verb::kArm, &Command::verb)->epoch, 17U);
  auto* stop = ros_side_.writer("rt/husky_1/stop", "std_msgs::msg::dds_::Bool_");
  ASSERT_TRUE(until([&] {
    stop->write(&yes);
    return asked(Command::Verb::kStop);
  }));
}

TEST_F(ForeignRos, APoseEstimate) {
  using clients::Command;
  start_core();
  std::vector<std::string> words;
  commands_too(words);
  start_ros(words);
  auto* pose = ros_side_.writer("rt/husky_1/initialpose", "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_");
  std::array<double, 36> covariance{};
  covariance[0] = covariance[7] = 0.25;
  covariance[35] = 0.04;
  Payload estimate = fast::payload_of(std::int32_t{0}, std::uint32_t{0}, std::string("husky_2/odom"), 3.0, -4.0, 0.0,
                                      0.0, 0.0, 1.0, 0.0, covariance);
  ASSERT_TRUE(until([&] {
    pose->write(&estimate);
    return std::ranges::count(core->commands, Command::Verb::kPlace, &Command::verb) > 0;
  }));
  const clients::Placement& place = std::ranges::find(core->commands, Command::Verb::kPlace, &Command::verb)->place;
  EXPECT_EQ(place.frame.view(), "husky_2");
  EXPECT_EQ(place.x, 3);
  EXPECT_EQ(place.y, -4);
  EXPECT_NEAR(place.yaw, M_PI, 1e-9);
  EXPECT_NEAR(place.sigma_m, 0.5, 1e-9);
  EXPECT_NEAR(place.sigma_rad, 0.2, 1e-9);
}

}  // namespace
}  // namespace cairn::ros
