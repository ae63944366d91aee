// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/run.hpp"

#include "hal/workers.hpp"
#include "onboard/app/allocations.hpp"
#include "onboard/app/run_output.hpp"
#include "onboard/app/stop_signal.hpp"
#include "onboard/robot.hpp"

namespace cairn {
namespace {

constexpr Duration kPollTimeout = std::chrono::milliseconds(50);
// Until here buffers grow to what a scan needs; allocations are counted afterwards.
constexpr std::size_t kWarmUpScans = 20;

/// Feeds packets to decoders and scans to the robot.
class Loop {
 public:
  Loop(Door& door, Robot& robot, Monitor& monitor, const RunOptions& options, const RobotProfile& profile)
      : door_(door), robot_(robot), monitor_(monitor), options_(options), profile_(profile) {}

  void go() {
    while (!stop_requested() && !time_is_up()) {
      const auto polled = door_.source->next(packet_, kPollTimeout);
      if (!polled)
        monitor_.event(door_.clock().now(), "input", to_string(polled.error()));
      else if (*polled == Poll::kEnd)
        break;
      else if (*polled == Poll::kTimeout)
        expire();
      else
        receive();
    }
    ending_ = true;
    for (const auto& decoder : door_.decoders)
      if (decoder != nullptr) use(decoder->flush());
  }

  [[nodiscard]] const LoopFigures& figures() const { return figures_; }

 private:
  void receive() {
    door_.advance_to(packet_.arrival);
    if (!figures_.start) figures_.start = packet_.arrival;
    figures_.end = packet_.arrival;
    ScanDecoder* decoder = door_.decoder(packet_.source);
    if (decoder == nullptr) return;
    const auto scan = decode(*decoder);
    if (!scan)
      monitor_.event(packet_.arrival, "decode", scan.error().cause);
    else
      use(*scan);
  }

  Result<const Scan*> decode(ScanDecoder& decoder) {
    const StageTimer timing(monitor_.stage("decode"));
    return decoder.decode(packet_);
  }

  void expire() {
    for (const auto& decoder : door_.decoders)
      if (decoder != nullptr) use(decoder->expire(door_.clock().now()));
  }

  void use(const Scan* scan) {
    if (scan == nullptr) return;
    ++figures_.scans;
    figures_.lost_packets += scan->lost_packets;
    // The first and the last revolution are cut by where the data begins and ends: nothing is wrong with the sensor.
    if (scan->incomplete && figures_.scans > 1 && !ending_)
      monitor_.event(scan->valid.end, "lidar", "incomplete scan: packets were lost or late, or the motor stood");
    // A map that begins with a part of a turn leaves directions open, and every later pose would refer to it.
    if (scan->incomplete && figures_.scans == 1 && !ending_) return;
    const std::uint64_t before = allocations_of_this_thread();
    Budget budget = Budget::until(scan->valid.end + from_seconds(profile_.odometry_deadline_s), door_.clock(),
                                  profile_.odometry.max_iterations);
    if (const auto step = robot_.step(*scan, budget); !step)
      monitor_.event(scan->valid.end, "odometry", to_string(step.error()));
    if (figures_.scans > kWarmUpScans) figures_.allocations += allocations_of_this_thread() - before;
    if (options_.progress) options_.progress(scan->valid.end, figures_.scans);
  }

  [[nodiscard]] bool time_is_up() const {
    return options_.seconds && figures_.start && figures_.end - *figures_.start > from_seconds(*options_.seconds);
  }

  Door& door_;
  Robot& robot_;
  Monitor& monitor_;
  const RunOptions& options_;
  const RobotProfile& profile_;
  Packet packet_;
  LoopFigures figures_;
  bool ending_ = false;
};

Result<Door> open_door(const RunOptions& options, RobotProfile& profile, Monitor& monitor) {
  return options.recording.empty() ? open_devices(profile, monitor)
                                   : open_recording(options.recording, options.pace, profile, monitor);
}

}  // namespace

Result<std::unique_ptr<RunResult>> run(const RunOptions& options) {
  auto profile = load_profile(options.config);  // every fault at once, or valid
  if (!profile) return profile.error();
  if (options.threads) profile->threads = *options.threads;
  if (const auto ready = prepare_output(options.out); !ready) return ready.error();
  auto result = std::make_unique<RunResult>();
  auto door = open_door(options, *profile, result->monitor);  // live devices, or a recording
  if (!door) return door.error();

  Workers workers(static_cast<unsigned>(profile->threads));
  Robot robot(profile->robot(), workers, result->monitor);
  Loop loop(*door, robot, result->monitor, options, *profile);
  loop.go();  // packets → scans → poses and map

  const RunFacts facts{options, *profile, *door, robot, result->monitor, loop.figures()};
  auto report = write_output(facts);
  if (!report) return report.error();
  result->report = std::move(*report);
  return result;
}

}  // namespace cairn
