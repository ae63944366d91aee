// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "tests/faults/campaign.hpp"

namespace cairn::faults {
namespace {

/// Two cameras look for somebody, and one of them is wrong.
Row eye_row(const char* id, const char* fault, const char* requirement, const char* test) {
  return {id, fault, requirement, {}, {}, safety::Mode::kNormal, std::string("faults/CameraFaults.") + test};
}

std::vector<Row> rows_of_two_cameras() {
  return {
      eye_row("L26", "colour camera silent or frozen while people are followed",
              "The thermal camera finds the people. A repeated picture counts neither for nor against anybody.",
              "AFrozenColourCameraIsNoEvidence"),
      eye_row("L27", "thermal camera silent or frozen while people are followed",
              "As for L26, by the colour camera. A frame counter that goes on does not hide a frozen picture.",
              "AFrozenThermalCameraIsNoEvidence"),
      eye_row("L28", "colour camera overexposed",
              "Its pictures are not looked at, with an event. The thermal camera finds the people.",
              "AnOverexposedColourCamera"),
      eye_row("L29", "thermal camera overexposed: half of its pixels are at the end of their range",
              "As for L28, by the colour camera.", "AnOverexposedThermalCamera"),
      eye_row("L30", "thermal camera in flat-field correction",
              "Its pictures are not looked at, without an event. The colour camera finds the people.",
              "AThermalCameraInFlatFieldCorrectionIsNoFault"),
      eye_row("L31", "colour camera turned by 2°",
              "The event camera_moved. Its silence counts for nothing. The thermal camera finds the people.",
              "AColourCameraThatIsTurnedByTwoDegrees"),
      eye_row("L32", "thermal camera turned by 2°", "As for L31, by the colour camera.",
              "AThermalCameraThatIsTurnedByTwoDegrees"),
  };
}

/// A robot without a LiDAR.
std::vector<Row> stereo_rows() {
  return {
      {"L33",
       "a robot without a LiDAR: its stereo camera sees nothing for a fifth of a second",
       "Odometry says that it is lost. It goes on in the same map with the next good picture.",
       {},
       {},
       safety::Mode::kNormal,
       "visual_odometry/StereoOdometry.AShortDarknessIsSaidAndBridged"},
      {"L34",
       "a robot without a LiDAR: its stereo camera sees nothing for two seconds",
       "As for L33, but a new map begins where nothing known is in view. An event says so.",
       {},
       {},
       safety::Mode::kNormal,
       "visual_odometry/StereoOdometry.AfterALongDarknessANewMapBeginsAndIsSaid"},
      {"L35",
       "a robot without a LiDAR: its stereo camera is frozen",
       "Repeated pictures are not looked at. Odometry is lost, and the robot holds.",
       {},
       {},
       safety::Mode::kHold,
       "app/StereoRun.AFrozenCameraIsALostRobot"},
      {"L36",
       "a calibrated camera is knocked by 1.2° while the robot drives, nobody is around",
       "The event camera_moved says by how much it is turned, at most 20 s later. Geometry goes on.",
       {},
       {},
       safety::Mode::kNormal,
       "mount/MountWatchTest.NoticesAKnockDuringTheDrive"},
  };
}

}  // namespace

std::vector<Row> eye_rows() {
  std::vector<Row> rows = rows_of_two_cameras();
  const std::vector<Row> stereo = stereo_rows();
  rows.insert(rows.end(), stereo.begin(), stereo.end());
  return rows;
}

}  // namespace cairn::faults
