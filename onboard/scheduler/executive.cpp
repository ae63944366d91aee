// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/executive.hpp"

#include <algorithm>

namespace cairn::scheduler {

Time Executive::stop_time() const {
  Time last = Time::min();
  for (const Line& line : lines_)
    if (line.input) last = std::max(last, line.ended_at());
  return last == Time::max() || last == Time::min() ? Time::max() : last + kTail;
}

bool Executive::inputs_reached(Time t) const {
  return std::all_of(lines_.begin(), lines_.end(), [t](const Line& l) { return !l.input || l.progress.reached(t); });
}

bool Executive::over(const Line& line, Time release) const {
  if (release > last_release_) return true;
  return line.history != nullptr ? line.next.load(std::memory_order_relaxed) >= line.history->end
                                 : release > stop_time();
}

Result<void> Executive::prepare(const ReplayOptions& options) {
  last_release_ = options.length < Time::max() - options.start ? options.start + options.length : Time::max();
  for (Line& line : lines_) {
    line.releases = {options.start + line.spec.phase(), line.spec.period()};
    line.next = 0;
    line.progress.reach(line.releases.first - Duration{1});
    if (options.log == nullptr || line.live_only) continue;
    line.history = options.log->find(line.spec.name);
    if (line.history == nullptr || line.history->releases.period != line.releases.period)
      return Error{Errc::kInvalidConfig,
                   "the schedule log is of another schedule",
                   line.spec.name,
                   {},
                   "replay with the profile of the live run (its config.yaml)"};
    line.releases = line.history->releases;
  }
  return {};
}

Result<void> Executive::run_replay(const ReplayOptions& options) {
  if (const auto ready = prepare(options); !ready) return ready;
  if (options.pace == nullptr)
    run_serial(options);
  else
    run_threads(options);
  drain(nullptr);
  return {};
}

void Executive::replay_tick(Line& line, Gate* gate, const Clock* figures) {
  TickRecord record = line.due();
  if (line.history != nullptr && !record.idle()) ++line.repeated;
  const Time release = line.releases.at(record.index);
  Tick tick(line.history != nullptr ? Regime::kLogged : Regime::kVirtual, release, record, gate, figures);
  line.task->tick(tick);
  ++line.stats.ticks;
  line.end_at(tick);
  line.next = record.index + 1;
  line.progress.reach(line.releases.at(record.index + 1) - Duration{1});
  if (gate != nullptr) gate->open();
}

/// The line that is released next and can run; null when all are over. What a live tick took may have come from a tick
/// that was released later but ran earlier: then that one comes first here, too.
Line* Executive::next_line(bool only_ready) {
  Line* best = nullptr;
  Time best_release = Time::max();
  for (Line& line : lines_) {
    if (line.live_only) continue;
    const TickRecord record = line.due();
    const Time release = line.releases.at(record.index);
    if (over(line, release) || (best != nullptr && release >= best_release)) continue;
    const auto holds = [&](const ChannelBase* channel) { return channel->holds(record); };
    if (only_ready && !std::all_of(line.from.begin(), line.from.end(), holds)) continue;
    best = &line;
    best_release = release;
  }
  return best;
}

void Executive::run_serial(const ReplayOptions& options) {
  const auto next = [&] {
    Line* line = next_line(options.log != nullptr);
    if (line != nullptr || options.log == nullptr) return line;
    // None has what it took then. Going on shows how much is missing; stopping would hide it.
    line = next_line(false);
    diverged_ = diverged_ || line != nullptr;
    return line;
  };
  while (Line* line = next()) replay_tick(*line, nullptr, nullptr);
}

/// When all have run: every task uses what is left, and the ends of the chain hand on what they held back.
void Executive::drain(const Clock* clock) {
  TickRecord unused;
  Time end = Time::min();
  for (const Line& line : lines_)
    if (!line.live_only) end = std::max(end, line.releases.at(line.next));
  const auto each = [&](auto act) {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (lines_[i].live_only) continue;
      Tick tick(Regime::kDrain, end, unused, nullptr, clock);
      act(i, tick);
    }
  };
  const auto use_all = [&](std::size_t i, Tick& tick) { lines_[i].task->tick(tick); };
  each(use_all);
  each([&](std::size_t i, Tick& tick) {
    lines_[i].task->finish(tick);
    for (std::size_t after = i + 1; after < lines_.size(); ++after)
      if (!lines_[after].live_only) use_all(after, tick);
  });
}

}  // namespace cairn::scheduler
