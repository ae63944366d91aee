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

/// What odometry and mapping hand to the task that saves; neither ever waits for it.
struct ToSave {
  /// A copy of the map and the pose of the last scan in it.
  struct Map {
    std::unique_ptr<mapping::SemanticOcTree> tree;
    TrackPoint newest;  ///< where the last scan in it was
  };
  /// A placed scan and its epoch.
  struct Scan {
    odometry::PlacedScan scan;
    std::uint32_t epoch = 0;
  };
  LatestValue<TrackPoint> pose;  ///< from odometry
  SpscQueue<Scan> scans{16};     ///< from mapping
  SpscQueue<Map> maps{1};        ///< likewise
};

/// The part of the saving that is mapping's, live: scans that a restart needs, and from time to time a copy of the map.
class MapCopier {
 public:
  /// `out` must outlive the copier. `selection`: of the scans in epoch 0, which is that of a run that goes on.
  MapCopier(const odometry::OdometryConfig& odometry, Duration every, const odometry::ScanSelection& selection,
            ToSave& out)
      : every_(every), out_(out), thin_(odometry), selection_(selection) {}

  /// After every scan that is in the map.
  void mapped(const LocatedScan& scan);
  /// When there is no scan to be mapped: a millisecond of copying, if a copy is due and the one before was taken.
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
