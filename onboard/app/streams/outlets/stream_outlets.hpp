// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/drive/wheel_decoder.hpp"
#include "hal/drive.hpp"
#include "hal/latest_value.hpp"
#include "hal/spsc_queue.hpp"
#include "onboard/app/streams/outlets/picture_outlet.hpp"
#include "onboard/app/streams/outlets/tile_outlet.hpp"
#include "onboard/robot.hpp"
#include "onboard/safety/failsafe.hpp"
#include "onboard/safety/overload.hpp"

namespace cairn::app {

/// A pose, and all that is needed to predict the next ones.
struct PoseNews {
  TrackPoint point;
  odometry::MotionFilter filter;  ///< at `point`
  odometry::MotionNoise noise;    ///< that odometry expects of the next step
};

/// The people around a robot, after a scan.
struct PeopleNews {
  std::uint64_t robot = 0;  ///< the peer who follows them; 0: this robot
  Time stamp{};
  std::uint32_t epoch = 0;
  std::vector<people::Person> people;
};

/// How the robot is.
struct StateNews {
  safety::FailsafeDecision decision;
  std::optional<DriveStatus> drive{};  ///< none: nothing is known of a drive
  safety::Shed shed{};
  std::uint64_t scans = 0;
  std::optional<SE3> T_team_odom{};  ///< none: in no team, or not known yet
};

/// What the wheels measured.
struct WheelNews {
  DriveState state;
  drive::WheelMotions wheels;
};

/// What the tasks of a live run hand to the task that serves robot.sock. They never wait for it.
struct StreamOutlets {
  SpscQueue<PoseNews> poses{64};                      ///< from odometry, one for each scan
  std::atomic<bool> scans_wanted{false};              ///< a client wants scans, or clouds that are made of them
  SpscQueue<PeopleNews> people{16};                   ///< from mapping, one for each scan while people are followed
  SpscQueue<PeopleNews> team_people{32};              ///< from the team's task, whenever a peer said something
  SpscQueue<LocatedScan> scans{4};                    ///< from odometry, while they are wanted
  std::array<PictureOutlet, kShownCameras> pictures;  ///< by camera
  PictureOutlet thermal;                              ///< of the thermal camera, for clouds
  std::atomic<bool> wheels_wanted{false};             ///< a client wants to know of the wheels
  SpscQueue<WheelNews> wheels{64};                    ///< from the drive's task, while they are wanted
  TileOutlet own;                                     ///< from mapping
  TileOutlet team;                                    ///< from the team's task
  LatestValue<std::optional<DriveStatus>> drive;      ///< from the drive's task, for the watch task
  LatestValue<std::optional<SE3>> T_team_odom;        ///< from the team's task, for the watch task
  LatestValue<StateNews> state;                       ///< from the watch task
};

}  // namespace cairn::app
