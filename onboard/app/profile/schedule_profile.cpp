// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/schedule_profile.hpp"

#include <string>

namespace cairn::app {

void declare(config::Section& s, ScheduleProfile& p) {
  s.group("safety", p.safety, "e-stop, time-outs and mode");
  s.group("drive", p.drive, "CAN frames in and out, after safety");
  s.group("receive", p.receive, "packets of all other sensors, and their decoders");
  s.group("odometry", p.odometry, "locates one scan at a time; looks for one at rate_hz, and finds one at busy_hz");
  s.group("mapping", p.mapping, "puts one located scan at a time into the map; rates as odometry");
  s.group("perception", p.perception, "looks at one picture at a time; its labels are in the map after the deadline");
  s.group("detection", p.detection, "looks for people in one colour picture at a time");
  s.group("thermal_detection", p.thermal_detection, "looks for people in one thermal picture at a time");
  s.group("mount", p.mount, "compares one picture at a time with the motion: was its camera moved?");
  s.group("depth", p.depth, "turns one depth picture at a time into points for the map");
  s.group("visual_odometry", p.visual_odometry, "of a robot without a LiDAR: locates one stereo picture at a time");
  s.group("stereo", p.stereo, "of a robot without a LiDAR: turns one stereo picture at a time into points for the map");
  s.group("team", p.team, "in a team: datagrams of peers, and a slice of the team's map");
  s.group("matching", p.matching, "in a team: compares maps, one pair at a time, for seconds if need be");
  s.group("rejoin", p.rejoin, "after the way was lost: compares the map with earlier ones, for deadline_ms at most");
  s.group("watch", p.watch, "events, signs of life, live view: waits for no disk");
  s.group("streams", p.streams,
          "robot.sock, where --sockets says so: poses, state, tiles and scans for other programs");
  s.group("housekeeping", p.housekeeping, "recording: everything that may wait for a disk");
  s.group("saving", p.saving, "map, pose, scans and keyframes for a restart, where --state says so");
}

Result<void> check(const ScheduleProfile& p) {
  constexpr double kSlowest_hz = 50;  // an e-stop takes up to four periods
  std::string faults;
  for (const scheduler::TaskSpec* task : {&p.safety, &p.drive})
    if (task->rate_hz < kSlowest_hz)
      faults += "\nschedule." + task->name +
                ".rate_hz is below 50 Hz: this task stops the robot, and an emergency stop would take tenths of a "
                "second; leave it out (500 Hz)";
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the profile", {}, {}, faults};
}

std::vector<scheduler::TaskSpec> ScheduleProfile::tasks(const Parts& parts) const {
  std::vector<scheduler::TaskSpec> all{safety, drive, receive};
  if (parts.stereo)
    all.insert(all.end(), {visual_odometry, stereo});
  else
    all.push_back(odometry);
  all.insert(all.end(), {mapping, rejoin, watch, streams, housekeeping, saving});
  if (parts.team) all.insert(all.end(), {team, matching});
  if (parts.perception) all.push_back(perception);
  if (parts.depth) all.push_back(depth);
  if (parts.detection) all.push_back(detection);
  if (parts.thermal_detection) all.push_back(thermal_detection);
  if (parts.mount) all.push_back(mount);
  return all;
}

void declare_stages(const ScheduleProfile& profile, bool by_eyes, Monitor& monitor) {
  const scheduler::TaskSpec& odometry = by_eyes ? profile.visual_odometry : profile.odometry;
  monitor.stage("odometry", odometry.soft());
  if (by_eyes) monitor.stage("stereo", profile.stereo.soft());
  monitor.stage("mapping", profile.mapping.soft());
  monitor.stage("packet_to_pose", odometry.deadline());
  monitor.stage("packet_to_map", (by_eyes ? profile.stereo.deadline() : Duration{}) + profile.mapping.deadline());
}

}  // namespace cairn::app
