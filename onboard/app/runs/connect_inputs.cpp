// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/connect_inputs.hpp"

#include <algorithm>

#include "drivers/clients/commands/command_packet.hpp"

namespace cairn::app {
namespace {

// Packets that may wait for the disk: two seconds of a LiDAR, edges of an e-stop, and a flood of commands for a second.
constexpr std::size_t kWaitingPackets = 2048, kWaitingEdges = 256, kWaitingCommands = 4096;
// The socket's reader asks for a byte more, and the drive task must not allocate.
static_assert(clients::kMaxCommandBytes < scheduler::Feed::kSmall);

scheduler::Feed::Tap tap(Recorder* recorder, std::size_t packets, std::size_t bytes) {
  return recorder != nullptr ? recorder->tap(packets, bytes) : scheduler::Feed::Tap{};
}

Result<void> connect_drive(RobotTasks& tasks, const RunContext& context, Input& input, SourceId id,
                           Recorder* recorder) {
  if (!context.profile.drive.exists()) {
    context.monitor.event({}, "drive", "left out: no profile says how to read it; name one with --config");
    return {};
  }
  const auto attached = tasks.drive.attach(context.profile.drive.driver, *input.source, id, input.can,
                                           tap(recorder, kWaitingPackets, scheduler::Feed::kSmall));
  if (attached && !tasks.drive.drive()->reads_wheels())
    context.monitor.event({}, "drive",
                          "its wheels are not read, so they bridge no gap of the LiDAR: the profile has no scales");
  return attached;
}

Result<void> connect(RobotTasks& tasks, const RunContext& context, Input& input, SourceId id, Recorder* recorder,
                     const scheduler::Feed::Tap& received) {
  const RobotProfile& profile = context.profile;
  if (input.entry.kind == recording::kGpio) {
    tasks.safety.use_lines(profile.gpio.driver, *input.source, id, input.lines,
                           tap(recorder, kWaitingEdges, scheduler::Feed::kSmall));
    return {};
  }
  if (input.entry.kind == recording::kCommands) return {};  // see connect_commands()
  if (input.entry.kind == recording::kDrive) return connect_drive(tasks, context, input, id, recorder);
  if (input.entry.kind == recording::kPeers)
    tasks.team->team().attach(*input.source, id, input.peers, tap(recorder, kWaitingPackets, peer_link::kMaxPacket));
  else if (!tasks.receive.add(input, id, received))
    context.monitor.event({}, "input", "more sources than are read: " + input.entry.id + " is left out");
  return {};
}

void name_triggered(const RobotProfile& profile, ReceiveTask& receive) {
  const auto name = [&](recording::SensorKind kind, const auto& driver) {
    if (driver.capture.triggered) receive.expose_by_trigger(kind, from_seconds(driver.latency_ms * 1e-3));
  };
  name(recording::kCamera, profile.camera.driver);
  name(recording::kThermal, profile.thermal.driver);
  name(recording::kDepth, profile.depth.driver);
}

/// After the drive, which they may command.
void connect_commands(RobotTasks& tasks, const RunContext& context, Recorder* recorder) {
  const RunOptions& options = context.options;
  const bool played = options.live() && !options.recording.empty();  // a recorded drive moves nothing
  std::size_t id = 0;
  for (Input& input : context.door.inputs) {
    const auto source = static_cast<SourceId>(id++);
    if (input.entry.kind == recording::kCommands)
      tasks.drive.obey_commands(*input.source, source, input.answers,
                                tap(recorder, kWaitingCommands, clients::kMaxCommandBytes), !played);
  }
}

}  // namespace

Result<void> connect_inputs(RobotTasks& tasks, const RunContext& context, Recorder* recorder) {
  name_triggered(context.profile, tasks.receive);
  const auto received = tap(recorder, kWaitingPackets, 0);  // one queue for all that one thread receives
  std::size_t id = 0;
  for (Input& input : context.door.inputs)
    if (auto done = connect(tasks, context, input, static_cast<SourceId>(id++), recorder, received); !done) return done;
  connect_commands(tasks, context, recorder);
  return {};
}

Time first_arrival(RobotTasks& tasks) {
  const Time team = tasks.team ? tasks.team->team().first_arrival() : Time::max();
  return std::min({tasks.safety.first_arrival(), tasks.drive.first_arrival(), tasks.receive.first_arrival(), team});
}

std::uint64_t missing_packets(const RobotTasks& tasks) {
  return tasks.receive.missing_packets() + tasks.drive.missing_packets() +
         (tasks.team ? tasks.team->team().missing_packets() : 0);
}

}  // namespace cairn::app
