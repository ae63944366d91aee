// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/saving_task.hpp"

namespace cairn {

void SavingTask::tick(scheduler::Tick& tick) { save(tick.release()); }
void SavingTask::close(Time now) { save(now); }

/// The pose first: it grows old fastest.
void SavingTask::save(Time now) {
  save_pose(now);
  save_scans(now);
  save_map(now);
}

void SavingTask::note(Time now, const Result<void>& saved) {
  failing_.store(!saved, std::memory_order_relaxed);
  if (!saved) monitor_.event(now, "saved map", to_string(saved.error()));
}

void SavingTask::save_pose(Time now) {
  if (!in_.pose.refresh()) return;
  const TrackPoint& point = in_.pose.value();
  if (point.lost) return;
  SavedState state;
  state.epoch = first_epoch_ + point.epoch;
  state.boot = boot_;
  state.stamp = point.stamp;
  state.T_odom_base = point.T_odom_base;
  state.twist = point.twist;
  note(now, generations_.save_state(state));
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

void SavingTask::save_map(Time now) {
  ToSave::Map* map = in_.maps.front();
  if (map == nullptr) return;
  SavedState state;
  state.epoch = first_epoch_ + map->epoch;
  state.boot = boot_;
  state.stamp = map->stamp;
  map->tree->canonicalise();
  const auto saved = generations_.save(*map->tree, state);
  map->tree.reset();
  in_.maps.pop();
  note(now, saved);
  if (saved) ++maps_saved_;
}

}  // namespace cairn
