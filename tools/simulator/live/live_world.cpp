// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/live_world.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace cairn::simulator {
namespace {

constexpr std::uint64_t kLiveLidarStream = 25;

}  // namespace

LiveWorld::LiveWorld(const Scene& scene, const Config& config, Ports ports, const Clock& clock)
    : ports_(std::move(ports)),
      clock_(clock),
      body_(scene.world, scene.plan, config.start),
      track_(clock.now(), body_.pose()),
      motors_(ports_.bus, config.drive, config.wheels, config.seed),
      lidar_(*velodyne::find_model("VLP-16"), scene.tracer, track_, config.lidar, config.start_utc_ns,
             mix(config.seed ^ kLiveLidarStream)),
      player_(lidar_, ports_.wire, clock) {
  motors_.power_on(track_.start());
}

void LiveWorld::play() {
  obey_bus();
  move_until(clock_.now());
  send_one();
  say_contacts();
  if (const auto late = player_.lateness().take_words(clock_.now())) ports_.say(*late);
}

void LiveWorld::send_one() {
  if (const auto sent = player_.play(track_.end()); !sent) say_fault("LiDAR", sent.error());
}

void LiveWorld::send_rest() {
  while (player_.due() <= track_.end()) send_one();
}

/// A packet needs the track until it is due, so it comes with the step that reaches that time.
Time LiveWorld::next_due() const {
  return player_.due() <= track_.end() ? track_.end() : track_.end() + RecentTrack::kStep;
}

/// Each frame takes effect when it was sent. So a world that slept for a moment moves as if it had not.
void LiveWorld::obey_bus() {
  for (int i = 0; i < kMostFrames; ++i) {
    const auto poll = ports_.bus.next(packet_, Duration::zero());
    if (!poll) say_fault("CAN", poll.error());
    if (!poll) continue;
    if (*poll != Poll::kPacket) return;
    if (packet_.channel != static_cast<std::uint16_t>(drive::Direction::kReceived)) continue;
    const auto frame = drive::decode_frame(packet_.payload());
    if (!frame) continue;
    move_until(std::min(packet_.arrival, clock_.now()));
    motors_.obey(*frame, track_.end());
  }
}

void LiveWorld::move_until(Time t) {
  while (track_.end() + RecentTrack::kStep <= t) move();
}

void LiveWorld::move() {
  const Time t = track_.end() + RecentTrack::kStep;
  motors_.step(t);
  body_.roll(motors_.take_travel(), motors_.wheels().separation_m);
  track_.append(body_.pose());
  if (ports_.truth && (t - track_.start()) % kTruthEvery == Duration::zero()) ports_.truth(t, track_.newest());
}

void LiveWorld::say_contacts() {
  if (body_.contacts() == contacts_said_) return;
  contacts_said_ = body_.contacts();
  char text[128];
  std::snprintf(text, sizeof text, "the robot has run into something at x %.2f, y %.2f: it stands and its wheels slip",
                body_.at().x, body_.at().y);
  ports_.say(text);
}

void LiveWorld::say_fault(const char* where, const Error& error) {
  const std::string fault = std::string(where) + ": " + to_string(error);
  if (fault == fault_ && track_.end() - fault_said_ < kFaultAgain) return;
  fault_ = fault;
  fault_said_ = track_.end();
  ports_.say(fault);
}

void play(LiveWorld& world, const std::function<void(Time)>& wait_until, const std::function<bool()>& ended) {
  while (!ended()) {
    world.play();
    wait_until(world.next_due());
  }
  world.send_rest();
}

}  // namespace cairn::simulator
