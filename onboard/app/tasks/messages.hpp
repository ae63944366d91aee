// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "drivers/gpio/line_event.hpp"
#include "hal/labels.hpp"
#include "hal/packet.hpp"
#include "hal/point_cloud.hpp"
#include "hal/time.hpp"
#include "onboard/app/perception/arrived_picture.hpp"
#include "onboard/robot.hpp"
#include "onboard/safety/failsafe.hpp"

namespace cairn::app {

// What the ports of the tasks carry.

/// A whole scan. From receive to odometry.
struct ArrivedScan {
  Scan scan;
  Time arrival{};  ///< of its last byte
};

/// A scan with its pose. From odometry to mapping.
struct ArrivedMotion {
  LocatedScan scan;
  Time arrival{};  ///< of the last byte of the scan
};

/// A rising edge of a GPIO line. From safety, which reads the lines, to receive.
struct LineEdge {
  gpio::Line line{};
  Time at{};
};

/// A stereo picture and where it was taken. From visual odometry to who measures its points.
struct ArrivedView {
  stereo::StereoPair pair;
  LocatedScan scan;  ///< without points
  Time arrival{};    ///< of the picture
};

/// What a network said of a picture. From perception to mapping.
struct ArrivedLabels {
  LabelImage labels;
};

/// What a detector saw in a picture. From detection to mapping.
struct ArrivedBoxes {
  people::Eye eye = people::Eye::kVisible;
  Detections boxes;
};

/// What a depth camera saw. From depth to mapping.
struct ArrivedCloud {
  DepthCloud cloud;
};

/// When each kind of sensor last gave good data, and the faults in its data. From receive to safety.
struct SensorsSeen {
  std::array<safety::Seen, safety::kWatched> seen{};
  safety::FaultSet faults;
};

/// The state of odometry. To safety, with every change.
struct OdometryNews {
  bool lost = false;  ///< the last scan did not fit: the pose is only a prediction
};

/// The state of the drive. To safety, with every change.
struct DriveNews {
  DriveStatus status;
  safety::Seen feedback;  ///< the last set of wheel readings
};

/// Somebody wants the robot to move again. From drive to safety.
struct RearmRequest {
  std::uint32_t epoch = 0;  ///< of the stop that is to end, as FailsafeDecision::epoch
};

}  // namespace cairn::app
