// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/streams/outlets/stream_outlets.hpp"
#include "onboard/robot.hpp"

namespace cairn::app {

/// Hands poses and located scans to the rest of a live run, from the thread that makes them. What finds no room is left
/// out. Without outlets it does nothing.
class PoseTeller {
 public:
  /// Every pose is written to `pose`, too. To be called before the run; `pose` must outlive the teller.
  void publish_to(LatestValue<TrackPoint>& pose) { published_ = &pose; }
  /// Every pose goes to `outlets`, too, and scans while they are wanted. To be called before the run; `outlets` must
  /// outlive the teller.
  void serve(StreamOutlets& outlets) { outlets_ = &outlets; }

  void tell(const TrackPoint& point, const Robot& robot);
  void tell(const LocatedScan& scan);

 private:
  LatestValue<TrackPoint>* published_ = nullptr;
  StreamOutlets* outlets_ = nullptr;
};

}  // namespace cairn::app
