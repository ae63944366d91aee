// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/mapping_task.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace cairn::app {

using scheduler::Regime;
using scheduler::Tick;

namespace {

// Between two batches of changed tiles, in time of scans.
constexpr Duration kBatchPeriod = std::chrono::milliseconds(500);
// For clients. Reading one takes some microseconds.
constexpr std::size_t kOwnTilesInATick = 256;

}  // namespace

MappingTask::MappingTask(const safety::OverloadConfig& overload, Duration deadline, Robot& robot, Monitor& monitor)
    : deadline_(deadline),
      overload_(overload),
      robot_(robot),
      monitor_(monitor),
      latency_(monitor.stage("packet_to_map")),
      label_joiner_(robot, monitor),
      cloud_joiner_(robot, monitor),
      box_joiner_(robot, monitor),
      rejoin_plan_(robot, monitor) {}

void MappingTask::tick(Tick& tick) {
  while (const Mates* news = mates.take(tick)) robot_.note_mates(news->mates, news->epoch);
  if (copier_ && motions.size() == 0) copier_->idle(tick.release(), robot_.map());
  bool idle = true;
  while (const ArrivedMotion* motion = motions.take(tick)) {
    idle = false;
    extend(*motion, tick);
    if (tick.regime() != Regime::kDrain) break;
  }
  motions.give_back(tick);
  take_pictures(tick);
  if (idle || tick.regime() == Regime::kDrain) rejoin(tick);
  if (tick.regime() == Regime::kDrain) hand_on_tiles(tick);
  if (outlet_ == nullptr) return;
  if (tick.release() > next_batch_ + kBatchPeriod) owe_changes();  // no further scan may come
  hand_to_clients(kOwnTilesInATick);
}

void MappingTask::extend(const ArrivedMotion& motion, Tick& tick) {
  const safety::Shed level = decide(motion, tick);
  const safety::Shed before = shed_in_force();
  level_.store(level, std::memory_order_relaxed);
  if (const safety::Shed now = shed_in_force(); now != before)
    monitor_.event(motion.scan.stamp, "overload", "shed: " + std::string(to_string(now)));
  ++scans_at_[static_cast<std::size_t>(level)];
  const safety::ShedPlan plan = safety::plan_of(level);
  if (count_++ % static_cast<std::uint64_t>(plan.scan_stride) != 0) return;
  if (robot_.follows_people_by_depth()) {
    robot_.announce(motion.scan);
    join_clouds(tick);
  }
  const auto extended = robot_.extend_map(motion.scan, {plan.point_stride});
  if (!extended)
    monitor_.event(motion.scan.stamp, "mapping", to_string(extended.error()));
  else if (copier_)
    copier_->mapped(motion.scan);
  if (extended && !motion.scan.lost) {
    if (!robot_.follows_people_by_depth()) note_people(motion.scan.stamp, motion.scan.T_odom_base.mean);
    rejoin_plan_.went_to(motion.scan.T_odom_base.mean, motion.scan.epoch);
  }
  note_changes(motion.scan, tick);
  memory_short_.store(!extended && extended.error().code == Errc::kLimit, std::memory_order_relaxed);
  if (tick.takes_time()) latency_.record(tick.figure_now() - motion.arrival);
}

void MappingTask::note_people(Time stamp, const SE3& T_odom_base) {
  people_log_.add(robot_.people(), T_odom_base.translation().head<2>());
  if (people_outlet_ == nullptr || !robot_.follows_people()) return;
  PeopleNews* out = people_outlet_->back();
  if (out == nullptr) return;
  out->stamp = stamp;
  out->epoch = robot_.map_epoch();
  out->people.assign(robot_.people().begin(), robot_.people().end());
  people_outlet_->push();
}

void MappingTask::join_clouds(Tick& tick) {
  while (ArrivedCloud* arrived = clouds.take(tick)) cloud_joiner_.add(arrived->cloud);
  cloud_joiner_.join([this](Time stamp, const SE3& T_odom_base) {
    if (robot_.follows_people_by_depth()) note_people(stamp, T_odom_base);
  });
}

/// Clouds first: what they add can be labelled. Boxes are told of people whom clouds have shown.
void MappingTask::take_pictures(Tick& tick) {
  for (auto* port : {&boxes, &thermal_boxes})
    while (ArrivedBoxes* arrived = port->take(tick)) box_joiner_.add(arrived->eye, arrived->boxes);
  const bool by_depth = robot_.follows_people_by_depth();
  if (!by_depth) box_joiner_.join(tick.release());
  join_clouds(tick);
  if (by_depth) box_joiner_.join(tick.release());
  while (ArrivedLabels* arrived = labels.take(tick)) label_joiner_.add(arrived->labels);
  label_joiner_.join(tick);
}

void MappingTask::rejoin(Tick& tick) {
  while (RejoinJob* result = rejoined.take(tick)) rejoin_plan_.take(std::move(*result), tick.release());
  if (tick.regime() == Regime::kDrain) return rejoin_plan_.finish(tick.release());
  if (!rejoin_jobs.connected()) return;
  auto job = rejoin_plan_.step(tick.release());
  if (!job) return;
  RejoinJob* out = rejoin_jobs.back(tick);
  if (out == nullptr) return rejoin_plan_.take(*std::move(job), tick.release());
  *out = *std::move(job);
  rejoin_jobs.push(tick);
}

void MappingTask::share_resumed_tiles() {
  resumed_tiles_ = mapping::known_tiles(robot_.map(), std::numeric_limits<std::size_t>::max());
}

void MappingTask::serve(TileOutlet& outlet) {
  outlet_ = &outlet;
  outlet.owe(mapping::known_tiles(robot_.map(), std::numeric_limits<std::size_t>::max()));
}

bool MappingTask::serve_rest() {
  if (!std::exchange(serving_rest_, true))
    outlet_->owe(mapping::known_tiles(robot_.map(), std::numeric_limits<std::size_t>::max()));
  hand_to_clients(std::numeric_limits<std::size_t>::max());
  return mapped_ == Time{} || outlet_->owed() == 0;
}

/// Tiles that the port has not taken yet stay with the map, so clients may get them twice.
void MappingTask::owe_changes() {
  if (std::exchange(owed_changes_, true)) return;
  outlet_->begin(robot_.map_epoch());
  if (tiles.connected())
    outlet_->owe(robot_.changed_tiles());
  else
    outlet_->owe(robot_.take_changed_tiles());
}

/// A resumed map waits until the first scan has told whether the robot is where that map ends.
void MappingTask::hand_to_clients(std::size_t most) {
  if (mapped_ == Time{}) return;
  outlet_->begin(robot_.map_epoch());
  outlet_->hand_over(most, [this](TileNews& news) {
    news.state = mapping::read_tile(robot_.map(), news.tile);
    news.changed = mapped_;
  });
}

/// Scans change the same tiles again and again. Reading them with each scan would be a quarter of the work in a forest.
void MappingTask::note_changes(const LocatedScan& scan, Tick& tick) {
  const bool lost = scan.lost || (changes_ && changes_->lost);
  changes_ = {scan.epoch, scan.T_odom_base, scan.twist, scan.stamp, lost};
  mapped_ = scan.stamp;
  owed_changes_ = false;
  if (scan.stamp < next_batch_ && scan.stamp >= next_batch_ - kBatchPeriod) return;
  next_batch_ = scan.stamp + kBatchPeriod;
  hand_on_tiles(tick);
}

/// Where the channel is full, tiles stay changed and go with the next batch.
void MappingTask::hand_on_tiles(Tick& tick) {
  if (outlet_ != nullptr) owe_changes();
  TileBatch* out = changes_ ? tiles.back(tick) : nullptr;
  if (out == nullptr) return;
  out->epoch = changes_->epoch;
  out->T_odom_base = changes_->T_odom_base;
  out->twist = changes_->twist;
  out->stamp = changes_->stamp;
  out->lost = changes_->lost;
  out->people.assign(robot_.people().begin(), robot_.people().end());
  out->tiles.clear();
  const auto add = [&](mapping::TileKey tile) {
    out->tiles.emplace_back(tile, mapping::read_tile(robot_.map(), tile));
  };
  if (changes_->epoch == 0) std::ranges::for_each(resumed_tiles_, add);
  resumed_tiles_.clear();
  std::ranges::for_each(robot_.take_changed_tiles(), add);
  tiles.push(tick);
  changes_.reset();
}

/// By how late this scan is already and how many wait behind it. A replay of a log sheds what was shed then; virtual
/// time knows no overload.
safety::Shed MappingTask::decide(const ArrivedMotion& motion, Tick& tick) {
  const auto measure = [&] {
    safety::Load load;
    load.utilisation = to_seconds(tick.figure_now() - motion.arrival) / to_seconds(deadline_);
    load.queue_fill = static_cast<double>(motions.size() - 1) / static_cast<double>(motions.capacity());
    return static_cast<std::int32_t>(overload_.step(tick.release(), load));
  };
  return static_cast<safety::Shed>(std::clamp(tick.decide(shed_slot, measure, 0), 0, safety::kShedLevels - 1));
}

}  // namespace cairn::app
