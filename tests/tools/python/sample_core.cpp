// SPDX-License-Identifier: Apache-2.0
// Serves a socket as a core does, for the tests of the Python module:  sample_core SOCKET
// Prints "ready". At the first byte of its input it says one message of each kind to whoever has subscribed. It ends
// when its input does.
#include <chrono>
#include <cstdio>

#include "drivers/camera/frame.hpp"
#include "drivers/clients/messages/clouds/scan.hpp"
#include "drivers/clients/messages/clouds/thermal.hpp"
#include "drivers/clients/sockets/local_server.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "onboard/client/robot_stream.hpp"

namespace {

using namespace cairn;
using clients::LocalServer;
using clients::TileMap;

class Speaker {
 public:
  explicit Speaker(const char* path) : server_(LocalServer::open({.path = path}).value()) {}

  /// Takes in the subscription. False: there is none.
  bool hear() {
    for (;;) {
      const auto got = server_.receive(bytes_, 1000);
      client_ = got.client;
      if (got.got != LocalServer::Got::kJoined) return got.got == LocalServer::Got::kRecord;
    }
  }
  template <class Message>
  void say(const Message& message) {
    clients::begin_record(Message::kKind, sequence_++, bytes_);
    encode(message, bytes_);
    end();
  }
  template <class Part, class Point>
  void say_cloud(const Part& part, const std::vector<Point>& points) {
    clients::begin_record(Part::kKind, sequence_++, bytes_);
    encode(part, std::span<const Point>(points), bytes_);
    end();
  }
  void say_picture(const clients::PicturePart& part, const std::vector<std::byte>& bytes) {
    clients::begin_record(clients::PicturePart::kKind, sequence_++, bytes_);
    encode(part, bytes, bytes_);
    end();
  }
  void say_tile(TileMap map, const clients::TilesMessage::Tile& tile) {
    clients::TilesWriter writer({.map = map, .session = 5}, sequence_++, bytes_);
    writer.add(tile);
    writer.finish(true);
    send();
  }

 private:
  void end() {
    clients::end_record(bytes_);
    send();
  }
  void send() {
    if (!server_.send(client_, bytes_)) std::fprintf(stderr, "a message was not sent\n");
  }

  LocalServer server_;
  LocalServer::ClientId client_ = 0;
  std::uint32_t sequence_ = 0;
  std::vector<std::byte> bytes_;
};

/// Eight voxels, one above the other: the lowest free, the others occupied.
clients::TilesMessage::Tile pillar() {
  mapping::TileState state;
  for (unsigned z = 0; z < 8; ++z) state.set(0, 0, z, z == 0 ? -1.6F : 3.5F);
  clients::TilesMessage::Tile tile{.key = mapping::TileKey::of_voxel(32'768, 32'768, 32'768).morton, .version = 1};
  peers::encode_tile(state, tile.bytes);
  return tile;
}

void say_everything(Speaker& core) {
  core.say(client::HelloMessage{.robot = "husky",
                                .session = 5,
                                .realtime_offset = std::chrono::seconds(3),
                                .resolution_m = 0.2,
                                .sensors = {{"lidar", SE3(Eigen::Quaterniond::Identity(), {0.2, 0, 0.6})}}});
  client::PoseMessage pose;
  pose.stamp = Time{std::chrono::seconds(1)};
  pose.epoch = 2;
  pose.T_odom_base.mean = SE3(Eigen::Quaterniond(0.6, 0, 0, 0.8), {1, 2, 3});
  pose.T_odom_base.covariance.diagonal().setConstant(0.25);
  pose.twist << 1, 0, 0, 0, 0, 0.5;
  core.say(pose);
  client::StateMessage state;
  state.mode = clients::RobotMode::kHold;
  state.cause = "lidar_silent";
  state.faults = {"lidar_silent"};
  core.say(state);
  clients::ScanPart scan;
  scan.total = 2;
  core.say_cloud(scan, std::vector<Eigen::Vector3f>{{1, 2, 3}, {4, 5, 6}});
  core.say_cloud(clients::ThermalPart{.stamp = Time{std::chrono::seconds(2)}, .celsius = true, .epoch = 2},
                 std::vector<ThermalPoint>{{{1, 2, 3}, 20.5F}, {{4, 5, 6}, 36}});
  client::PeopleMessage people;
  people.people.push_back({.id = 7, .sightings = 3, .seen = true, .position_odom = {5, 6, 0}, .velocity_odom = {1, 0}});
  core.say(people);
  core.say(client::CameraMessage{
      .name = "front", .width = 3, .height = 2, .lens = client::CameraMessage::Lens::kRadTan, .fx = 5, .fy = 6});
  std::vector<std::byte> picture;
  camera::append_header(picture, {static_cast<std::uint32_t>(camera::FrameFormat::kGrey), 3, 2, 3, false});
  for (int i = 0; i < 6; ++i) picture.push_back(static_cast<std::byte>(10 * i));
  core.say_picture({.stamp = Time{std::chrono::seconds(2)}}, picture);
  client::WheelsMessage wheels{.v = 0.5, .radius_m = 0.2};
  wheels.wheels = {{clients::WheelPlace::kLeft, 3, 0.25}};
  core.say(wheels);
  core.say(client::EventMessage{.count = 2, .stage = "odometry", .what = "lost"});
  core.say_tile(TileMap::kOwn, pillar());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  Speaker core(argv[1]);
  std::puts("ready");
  std::fflush(stdout);
  if (std::getchar() == EOF || !core.hear()) return 1;
  say_everything(core);
  while (std::getchar() != EOF) {
  }
}
