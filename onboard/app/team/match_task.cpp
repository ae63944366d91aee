// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/match_task.hpp"

#include <utility>

#include "fusion/matching/matcher.hpp"

namespace cairn::app {

using scheduler::Regime;
using scheduler::Tick;

void MatchTask::tick(Tick& tick) {
  if (tick.regime() == Regime::kDrain) return;
  if (team::MatchJob* job = jobs.take(tick)) {
    const StageTimer timing(stage_);
    Budget budget = tick.budget(steps_slot, tick.figure_now() + limit_, matching::kAmpleSteps);
    team::run(*job, budget);
    tick.settle(steps_slot, budget);
    if (team::MatchJob* place = results.back(tick)) {
      *place = std::move(*job);
      results.push(tick);
    }
  }
  jobs.give_back(tick);
}

}  // namespace cairn::app
