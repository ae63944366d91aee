// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/drive/can_drive.hpp"
#include "tools/simulator/live/live_world.hpp"
#include "tools/simulator/sensors/motor_bus.hpp"

namespace cairn::simulator::test {

using namespace std::chrono_literals;

/// One end of a CAN bus without sockets: what one end sends the other receives, stamped at that time.
class BusEnd final : public drive::CanLink {
 public:
  explicit BusEnd(const Clock& clock) : clock_(clock) {}
  void join(BusEnd& other) { other_ = &other; }

  Result<Poll> next(Packet& packet, Duration) override {
    if (inbox_.empty()) return Poll::kTimeout;
    packet = inbox_.front();
    inbox_.pop_front();
    return Poll::kPacket;
  }
  drive::SendResult send(const drive::CanFrame& frame) override {
    Packet packet;
    packet.arrival = clock_.now();
    drive::encode_frame(frame, packet);
    other_->inbox_.push_back(packet);
    packet.channel = static_cast<std::uint16_t>(drive::Direction::kSent);
    inbox_.push_back(packet);
    return drive::SendResult::kSent;
  }
  Result<void> restart() override { return {}; }

 private:
  const Clock& clock_;
  BusEnd* other_ = nullptr;
  std::deque<Packet> inbox_;
};

/// A hall of 20 m × 12 m from the origin, with a pillar of 1 m in its middle.
inline World hall() {
  World world;
  world.mesh.box({10, 6, 0, 0}, 20, 12, 3, Material::kPlaster);
  world.mesh.cylinder({10, 6, 0, 0}, 0.5, 0.5, 3, 64, Material::kConcrete);
  world.bounds = world.mesh.bounds();
  world.ground = [](double, double) { return 0.0; };
  return world;
}

/// A live world in virtual time, and the drive of a robot's program on its bus, ticked every 10 ms.
class LiveRobot {
 public:
  static constexpr Duration kTick = 10ms;

  explicit LiveRobot(const GroundPose& start = {4, 3, 0}, const WheelConfig& wheels = exact(),
                     const LidarConfig& lidar = near_sighted()) {
    clock.advance_to(Time(100s));
    ours_.join(theirs_);
    theirs_.join(ours_);
    drive = drive::CanDrive::create(husky_drive(), theirs_).value();
    next_tick_ = clock.now();
    world.emplace(
        LiveWorld::Scene{world_, plan_, tracer_},
        LiveWorld::Config{.start = start, .lidar = lidar, .wheels = wheels, .drive = husky_drive()},
        LiveWorld::Ports{.bus = ours_,
                         .wire =
                             [this](LidarPlayer::Kind kind, std::span<const std::byte> bytes) {
                               take(kind, bytes);
                               return network_down ? Result<void>(Error{Errc::kIo, "no network"}) : Result<void>();
                             },
                         .truth = [this](Time t, const Vector6& pose) { truth.emplace_back(t, pose); },
                         .say = [this](const std::string& words) { said.push_back(words); }},
        clock);
  }
  static WheelConfig exact() { return {0, 0, 0, 0, 0}; }
  /// Its packets are cheap to make, for tests that do not look at what is in them.
  static LidarConfig near_sighted() {
    LidarConfig config;
    config.max_range_m = config.min_range_m;
    return config;
  }

  /// Both go on in small steps.
  void run(Duration duration) {
    const Time end = clock.now() + duration;
    while (clock.now() < end) {
      tick_program();
      world->play();
      clock.advance_to(std::min({end, world->next_due(), next_tick_}));
    }
  }
  /// The robot's program goes on, and the world stands still.
  void stall(Duration duration) {
    for (const Time end = clock.now() + duration; clock.now() < end; clock.advance_to(next_tick_)) tick_program();
  }
  /// Powered, configured, armed and enabled.
  void arm() {
    run(1s);
    const auto armed = drive->arm(clock.now());
    if (armed) epoch_ = *armed;
    run(500ms);
  }
  void go(double v, double w) { wanted = DriveCommand{v, w, 0}; }

  VirtualClock clock;
  std::optional<LiveWorld> world;
  std::unique_ptr<drive::CanDrive> drive;
  std::optional<DriveCommand> wanted;
  std::optional<DriveState> newest;
  bool silent = false;  ///< the robot's program hangs
  bool network_down = false;
  std::vector<Packet> packets;  ///< of the LiDAR, stamped when they were sent
  std::vector<std::pair<Time, Vector6>> truth;
  std::vector<std::string> said;

 private:
  void tick_program() {
    if (clock.now() < next_tick_) return;
    next_tick_ += kTick;
    if (silent) return;
    if (wanted) (void)drive->command({wanted->v, wanted->w, epoch_}, clock.now());
    if (auto state = drive->tick(clock.now()); state && *state != nullptr) newest = **state;
  }
  void take(LidarPlayer::Kind kind, std::span<const std::byte> bytes) {
    Packet& packet = packets.emplace_back();
    packet.channel = kind == LidarPlayer::Kind::kData ? velodyne::kDefaultDataPort : velodyne::kDefaultPositionPort;
    packet.arrival = clock.now();
    packet.bytes.assign(bytes.begin(), bytes.end());
  }

  World world_ = hall();
  FloorPlan plan_{world_};
  Tracer tracer_ = std::move(*Tracer::build(world_.mesh));
  BusEnd ours_{clock}, theirs_{clock};
  Time next_tick_{};
  std::uint32_t epoch_ = 0;
};

}  // namespace cairn::simulator::test
