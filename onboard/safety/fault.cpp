// SPDX-License-Identifier: Apache-2.0
#include "onboard/safety/fault.hpp"

namespace cairn::safety {
namespace {

constexpr Mode N = Mode::kNormal, D = Mode::kDegraded, H = Mode::kHold, S = Mode::kStop;

constexpr std::array<FaultRow, kFaults> kTable{{
    {Fault::kLidarLate, "lidar_late", D, D, "no good scan for lidar_late_ms"},
    {Fault::kLidarSilent, "lidar_silent", H, H, "no good scan for lidar_silent_ms"},
    {Fault::kLidarRejected, "lidar_rejected", H, H, "more than half of a second's LiDAR packets were refused"},
    {Fault::kLidarStuck, "lidar_stuck", H, H, "three LiDAR packets in a row are the same"},
    {Fault::kCameraSilent, "camera_silent", N, N, "no new picture for camera_silent_ms; geometry goes on"},
    {Fault::kThermalSilent, "thermal_silent", N, N, "no new thermal picture for thermal_silent_ms"},
    {Fault::kDepthSilent, "depth_silent", N, N, "no new depth picture for depth_silent_ms"},
    {Fault::kOdometryLost, "odometry_lost", D, D, "the last scan did not fit the map: the pose is a prediction"},
    {Fault::kFeedbackLate, "feedback_late", H, H, "no wheel feedback for feedback_late_ms"},
    {Fault::kFeedbackLost, "feedback_lost", S, S, "no wheel feedback for feedback_lost_ms"},
    {Fault::kBusFailing, "bus_failing", S, S, "the CAN controller is error-passive or left the bus"},
    {Fault::kLinkDown, "link_down", S, S, "the CAN interface is down or gone"},
    {Fault::kMotorFault, "motor_fault", S, S, "a motor controller reports a fault or does not enable"},
    {Fault::kMotorReset, "motor_reset", S, S, "a motor controller started anew while it should have been running"},
    {Fault::kSendQueueFull, "send_queue_full", H, H, "three CAN frames in a row found the queue full"},
    {Fault::kDriveNotReady, "drive_not_ready", H, H, "the motors are being enabled, or no valid command came"},
    {Fault::kEStopOpen, "estop_open", S, S, "the e-stop's contact is open"},
    {Fault::kEStopLost, "estop_lost", S, S, "the e-stop's level cannot be read, or edges were lost"},
    {Fault::kSafetyMissed, "safety_missed", H, H, "the safety task missed its deadline"},
    {Fault::kStageDemoted, "stage_demoted", D, D, "a stage overran its hard budget three times in a row"},
    {Fault::kOverload, "overload", N, D, "scans are mapped too late: work is left out, level by level"},
    {Fault::kBestEffort, "best_effort", N, N, "real-time priorities or locked memory were not granted"},
    {Fault::kMemoryShort, "memory_short", N, D, "a bound on memory was reached: the map does not grow any more"},
    {Fault::kDiskFailing, "disk_failing", N, N, "map or recording cannot be written"},
    {Fault::kStateLost, "state_lost", N, N, "no saved map could be read: the map began empty"},
    {Fault::kTaskHung, "task_hung", H, H, "a task did not answer within its limit"},
    {Fault::kCrashLoop, "crash_loop", S, S, "more than three restarts in a minute: telemetry only"},
}};

constexpr bool ordered() {
  for (std::size_t i = 0; i < kFaults; ++i)
    if (static_cast<std::size_t>(kTable[i].fault) != i || kTable[i].usual < kTable[i].least) return false;
  return true;
}
static_assert(ordered(), "one row for each fault, in the order of their numbers");

}  // namespace

const std::array<FaultRow, kFaults>& fault_table() { return kTable; }

std::string_view to_string(Fault fault) {
  const auto i = static_cast<std::size_t>(fault);
  return i < kFaults ? kTable[i].code : "unknown";
}

std::string_view to_string(Mode mode) {
  constexpr std::array<std::string_view, 4> kNames{"normal", "degraded", "hold", "stop"};
  return kNames[static_cast<std::size_t>(mode)];
}

}  // namespace cairn::safety
