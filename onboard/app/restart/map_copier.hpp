// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "hal/latest_value.hpp"
#include "hal/spsc_queue.hpp"
#include "onboard/mapping/tree/tree_copy.hpp"
#include "onboard/robot.hpp"

namespace cairn::app {

/// What odometry and mapping hand to the saving task. They never wait for it.
struct ToSave {
  /// A copy of the map and the pose of the last scan in it.
  struct Map {
    std::unique_ptr<mapping::SemanticOcTree> tree;
    TrackPoint newest;  ///< of the last scan in the map
  };
  /// A placed scan and its epoch.
  struct Scan {
    odometry::PlacedScan scan;
    std::uint32_t epoch = 0;
  };
  /// A keyframe of visual odometry and its epoch.
  struct Keyframe {
    visual_odometry::Keyframe keyframe;
    std::uint32_t epoch = 0;
  };
  LatestValue<TrackPoint> pose;       ///< from odometry
  SpscQueue<Keyframe> keyframes{16};  ///< from odometry
  SpscQueue<Scan> scans{16};          ///< from mapping
  SpscQueue<Map> maps{1};             ///< from mapping
};

/// Hands the scans that a restart needs, and now and then a copy of the map, to the saving task. Part of the mapping
/// task.
class MapCopier {
 public:
  /// `out` must outlive the copier. `every`: from the begin of one copy to the next. `selection`: of the scans in epoch
  /// 0.
  MapCopier(const odometry::OdometryConfig& odometry, Duration every, const odometry::ScanSelection& selection,
            ToSave& out)
      : every_(every), out_(out), thin_(odometry), selection_(selection) {}

  /// After every scan that is in the map.
  void mapped(const LocatedScan& scan);
  /// While no scan waits: copies for a millisecond, if a copy is due and the last one was taken.
  void idle(Time now, const mapping::SemanticOcTree& map);

 private:
  Duration every_;
  ToSave& out_;
  odometry::ScanThinning thin_;
  odometry::ScanSelection selection_;
  std::optional<mapping::TreeCopy> copy_;
  std::optional<Time> begun_;  // the last copy
  TrackPoint newest_;          // scan in the map
};

}  // namespace cairn::app
