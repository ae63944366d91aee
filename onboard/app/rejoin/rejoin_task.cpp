// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/rejoin/rejoin_task.hpp"

#include <limits>
#include <utility>

#include "fusion/matching/matcher.hpp"
#include "fusion/merging/moved_map.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::app {

using scheduler::Regime;
using scheduler::Tick;

void RejoinTask::tick(Tick& tick) {
  if (tick.regime() == Regime::kDrain) return;
  if (RejoinJob* job = jobs.take(tick)) {
    const StageTimer timing(stage_);
    Budget budget = tick.budget(steps_slot, tick.figure_now() + limit_, matching::kAmpleSteps);
    run(*job, budget);
    tick.settle(steps_slot, budget);
    if (RejoinJob* place = results.back(tick)) {
      *place = std::move(*job);
      results.push(tick);
    }
  }
  jobs.give_back(tick);
}

/// Null: the earlier map has too little that could be compared.
RejoinTask::Followed* RejoinTask::followed(const RejoinJob& job) {
  if (std::exchange(present_epoch_, job.present_epoch) != job.present_epoch) followed_.clear();
  const auto known = followed_.find(job.earlier_epoch);
  if (known != followed_.end()) return &known->second;
  auto features = matching::MapFeatures::build(*job.earlier);
  if (!features) return nullptr;
  return &followed_.try_emplace(job.earlier_epoch, Followed{job.earlier, *std::move(features)}).first->second;
}

void RejoinTask::run(RejoinJob& job, Budget& budget) {
  const auto present = std::exchange(job.present, nullptr);
  present->canonicalise();
  const auto features = matching::MapFeatures::build(*present);
  Followed* earlier = features ? followed(job) : nullptr;
  if (earlier == nullptr) return;
  earlier->match.update(*features, earlier->features, budget, job.guess);
  const matching::Hypothesis* found = earlier->match.hypotheses().accepted();
  if (found == nullptr) return;
  auto moved = merging::moved_map(*job.earlier, found->T_a_b.mean);
  if (!moved) return;
  job.T_present_earlier = found->T_a_b;
  job.moved = *std::move(moved);
  job.tiles = mapping::known_tiles(*job.moved, std::numeric_limits<std::size_t>::max());
  followed_.erase(job.earlier_epoch);
}

}  // namespace cairn::app
