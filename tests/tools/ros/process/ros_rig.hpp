// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <optional>
#include <string>
#include <vector>

#include "drivers/camera/frame.hpp"
#include "drivers/clients/messages/camera.hpp"
#include "drivers/clients/messages/event.hpp"
#include "drivers/clients/messages/pose.hpp"
#include "drivers/clients/messages/state.hpp"
#include "drivers/clients/messages/wheels.hpp"
#include "drivers/peers/domain_claim.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "hal/clock.hpp"
#include "onboard/mapping/tree/tile_state.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tools/ros/process/core_stand_in.hpp"

namespace cairn::ros {

/// A program that runs beside the test.
class RosProcess {
 public:
  explicit RosProcess(std::vector<std::string> words, const char* program = "cairn-ros") {
    words.insert(words.begin(), places::program(program));
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    EXPECT_EQ(::posix_spawn(&process_, arguments[0], nullptr, nullptr, arguments.data(), environ), 0);
  }
  RosProcess(const RosProcess&) = delete;
  RosProcess& operator=(const RosProcess&) = delete;
  ~RosProcess() { (void)end(SIGKILL); }
  /// The process's exit code; -1 if a signal ended it.
  int end(int signal) {
    if (process_ > 0) ::kill(process_, signal);
    return wait();
  }
  int wait() {
    int status = 0;
    if (process_ <= 0) return -1;
    ::waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  ::pid_t process_ = 0;
};

/// A core, cairn-ros beside it, and a network of ROS on loopback that no other test has.
class RosRig : public ::testing::Test {
 protected:
  static constexpr Duration kUtc = std::chrono::seconds(1'700'000'000);
  static constexpr double kResolution = 0.2;

  static clients::HelloMessage hello() {
    clients::HelloMessage hello{.robot = "husky-1", .robot_id = 3, .session = 8, .realtime_offset = kUtc};
    hello.resolution_m = kResolution;
    hello.sensors = {{"lidar", SE3(Eigen::Quaterniond(0.8, 0, 0, 0.6), {0.1, -0.2, 0.7})}, {"front", SE3()}};
    return hello;
  }
  [[nodiscard]] std::string domain() const { return std::to_string(claim_.domain()); }
  [[nodiscard]] unsigned domain_number() const { return claim_.domain(); }

  void start_core() { core.emplace(folder.path(), hello()); }
  void start_ros(std::vector<std::string> more = {}) {
    std::vector<std::string> words{
        "--socket", folder / "robot.sock", "--domain", domain(), "--interface", "lo", "--peer", "127.0.0.1"};
    words.insert(words.end(), more.begin(), more.end());
    ros.emplace(words);
  }
  void commands_too(std::vector<std::string>& words) const {
    words.insert(words.end(), {"--command-socket", folder / "command.sock"});
  }

  /// Says everything once more, each time a moment later in robot time, until `done`. Gives up after five minutes, as
  /// only a fault makes it.
  template <class Done>
  [[nodiscard]] bool until(Done done) {
    const LiveClock clock;
    for (const Time end = clock.now() + std::chrono::minutes(5); clock.now() < end;) {
      if (core) speak();
      if (done()) return true;
      LiveClock::wait_until(clock.now() + std::chrono::milliseconds(5));
    }
    return false;
  }

  [[nodiscard]] clients::PoseMessage pose() const {
    clients::PoseMessage pose;
    pose.stamp = now_;
    Vector6 place;
    place << 3, -2, 0.5, 0.2, -0.3, 2.1;
    pose.T_odom_base.mean = SE3::from_xyz_rpy(place);
    for (int i = 0; i < 6; ++i) pose.T_odom_base.covariance(i, i) = 0.01 * (i + 1);
    pose.T_odom_base.covariance(0, 5) = pose.T_odom_base.covariance(5, 0) = 0.004;
    pose.twist << 1, 2, 3, 4, 5, 6;
    return pose;
  }
  [[nodiscard]] clients::StateMessage state() const {
    clients::StateMessage state;
    state.stamp = now_;
    state.mode = clients::RobotMode::kStop;
    state.cause = "estop";
    state.faults = {"estop", "lidar_silent"};
    state.arming_epoch = 17;
    state.T_team_odom = SE3(Eigen::Quaterniond(0.8, 0, 0, 0.6), {5, 6, 7});
    return state;
  }
  static std::vector<Eigen::Vector3f> points() {
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 5000; ++i)
      points.emplace_back(0.25F * static_cast<float>(i), -1.5F, 0.001F * static_cast<float>(i));
    return points;
  }
  static clients::CameraMessage camera() {
    return {.camera = 1,
            .name = "front",
            .width = 8,
            .height = 4,
            .lens = clients::CameraMessage::Lens::kRadTan,
            .fx = 10,
            .fy = 11,
            .cx = 4,
            .cy = 2,
            .k = {0.1, 0.2, 0.3, 0.4, 0.5}};
  }
  static std::vector<std::byte> pixels() {
    std::vector<std::byte> pixels;
    for (int i = 0; i < 8 * 4 * 2; ++i) pixels.push_back(static_cast<std::byte>(3 * i));
    return pixels;
  }
  /// 16 bit, so that a foreign reader gets it exactly.
  static std::vector<std::byte> picture() {
    std::vector<std::byte> bytes;
    camera::append_header(bytes, {static_cast<std::uint32_t>(camera::FrameFormat::kY16), 8, 4, 16, false});
    const auto values = pixels();
    bytes.insert(bytes.end(), values.begin(), values.end());
    return bytes;
  }
  [[nodiscard]] clients::WheelsMessage wheels() const {
    clients::WheelsMessage wheels{.stamp = now_, .v = 0.5, .radius_m = 0.5};
    wheels.wheels = {{clients::WheelPlace::kLeft, 2, 0.25}, {clients::WheelPlace::kRight, -1, -0.5}};
    return wheels;
  }
  static mapping::TileState wall() {
    mapping::TileState wall;
    for (unsigned i = 0; i < 64; ++i) {
      wall.set(3, i & 7U, i >> 3U, i < 20 ? 3.5F : 1.5F);
      wall.set(2, i & 7U, i >> 3U, -1.6F);
    }
    return wall;
  }
  static mapping::TileKey place_of(clients::TileMap map) {
    return mapping::TileKey::of_voxel(map == clients::TileMap::kOwn ? 32'768 : 32'800, 32'776, 32'768);
  }
  static clients::TilesMessage tiles(clients::TileMap map) {
    clients::TilesMessage::Tile tile{.key = place_of(map).morton, .version = 1, .changed = Time{}};
    peers::encode_tile(wall(), tile.bytes);
    return {.map = map, .caught_up = true, .session = 8, .epoch = 0, .tiles = {tile}};
  }

  support::TemporaryFolder folder;
  std::optional<CoreStandIn> core;
  std::optional<RosProcess> ros;

 private:
  void speak() {
    using clients::Stream;
    core->hear();
    if (!core->subscription) return;
    now_ += std::chrono::milliseconds(20);
    const clients::SubscribeMessage& wants = *core->subscription;
    if (wants.wants(Stream::kPose)) core->say(pose());
    if (wants.wants(Stream::kState)) core->say(state());
    if (wants.wants(Stream::kEvents))
      core->say(clients::EventMessage{.stamp = now_, .count = 2, .stage = "odometry", .what = "scan refused"});
    if (wants.wants(Stream::kOwnTiles)) core->say_tiles(tiles(clients::TileMap::kOwn));
    if (wants.wants(Stream::kTeamTiles)) core->say_tiles(tiles(clients::TileMap::kTeam));
    if (wants.wants(Stream::kCameras)) core->say(camera());
    if (wants.wants(Stream::kWheels)) core->say(wheels());
    if (wants.wants(Stream::kPictures)) core->say_picture({.stamp = now_, .camera = camera().camera}, picture());
    if (wants.wants(Stream::kScan)) core->say_scan({.stamp = now_, .T_odom_base = pose().T_odom_base.mean}, points());
  }

  peer_link::DomainClaim claim_ = peer_link::DomainClaim::make().value();
  Time now_{std::chrono::seconds(100)};
};

}  // namespace cairn::ros
