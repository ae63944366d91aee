// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/saving_task.hpp"

#include <algorithm>

namespace cairn::app {

/// The pose first: it grows old fastest.
void SavingTask::save(Time now) {
  save_pose(now);
  save_scans(now);
  save_keyframes(now);
  save_copy(now);
}

void SavingTask::close(Time now, const Robot& robot) {
  save(now);
  const auto& track = robot.track();
  const auto known = std::find_if(track.rbegin(), track.rend(), [](const TrackPoint& p) { return !p.lost; });
  if (known != track.rend()) save_map(now, robot.map(), *known);
}

SavedState SavingTask::state_at(const TrackPoint& point) const {
  SavedState state;
  state.epoch = first_epoch_ + point.epoch;
  state.boot = boot_;
  state.stamp = point.stamp;
  state.T_odom_base = point.T_odom_base;
  state.twist = point.twist;
  return state;
}

void SavingTask::note(Time now, const Result<void>& saved) {
  failing_.store(!saved, std::memory_order_relaxed);
  if (!saved) monitor_.event(now, "saved map", to_string(saved.error()));
}

void SavingTask::save_pose(Time now) {
  if (!in_.pose.refresh()) return;
  const TrackPoint& point = in_.pose.value();
  if (point.lost) return;
  note(now, generations_.save_state(state_at(point)));
}

void SavingTask::save_scans(Time now) {
  bool news = false;
  for (; ToSave::Scan* scan = in_.scans.front(); in_.scans.pop()) {
    if (scan->epoch != scans_epoch_) scans_ = {};
    scans_epoch_ = scan->epoch;
    scans_.add(scan->scan);
    news = true;
  }
  if (!news) return;
  note(now, generations_.save_scans({first_epoch_ + scans_epoch_, {scans_.scans().begin(), scans_.scans().end()}}));
}

void SavingTask::save_keyframes(Time now) {
  bool news = false;
  for (; const ToSave::Keyframe* in = in_.keyframes.front(); in_.keyframes.pop()) {
    if (in->epoch != keyframes_epoch_) keyframes_.clear();
    keyframes_epoch_ = in->epoch;
    keyframes_.push_back(in->keyframe);
    if (keyframes_.size() > visual_odometry::PlaceMemory::kPlaces) keyframes_.pop_front();
    news = true;
  }
  if (!news) return;
  note(now, generations_.save_keyframes({first_epoch_ + keyframes_epoch_, {keyframes_.begin(), keyframes_.end()}}));
}

void SavingTask::save_copy(Time now) {
  ToSave::Map* map = in_.maps.front();
  if (map == nullptr) return;
  map->tree->canonicalise();
  save_map(now, *map->tree, map->newest);
  map->tree.reset();
  in_.maps.pop();
}

void SavingTask::save_map(Time now, const mapping::SemanticOcTree& map, const TrackPoint& newest) {
  note(now, generations_.save(map, state_at(newest)));
}

}  // namespace cairn::app
