// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/scheduler/tick.hpp"

namespace cairn::scheduler {

/// Does nothing. Its figures show what the machine alone costs.
class IdleTask final : public Task {
 public:
  void tick(Tick& /*tick*/) override {}
};

}  // namespace cairn::scheduler
