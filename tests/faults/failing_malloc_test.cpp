// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/failing_malloc.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "onboard/app/restart/generations.hpp"
#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::faults {
namespace {

TEST(FailingMalloc, ASaveThatGetsNoMemoryIsAnErrorAndKeepsTheGenerationBefore) {
  const support::TemporaryFolder folder;
  Monitor monitor;
  app::Generations generations(folder.path(), monitor);
  const auto map = mapping::random_map<mapping::SemanticOcTree>(1, 500);
  app::SavedState state;
  ASSERT_TRUE(generations.save(*map, state));
  int refused = 0;
  for (long n = 0;; ++n) {
    state.stamp = Time{Duration{n + 1}};
    fail_allocation(n);
    const auto saved = generations.save(*map, state);
    const bool reached = allocation_failed();
    fail_allocation(-1);
    const auto newest = app::Generations(folder.path(), monitor).load(Time{});
    ASSERT_TRUE(newest) << n;
    // Where only the syncing of the folder had no memory, the new one is there already.
    EXPECT_TRUE(!saved || newest->state.stamp == state.stamp) << n;
    if (!reached) break;
    refused += saved ? 0 : 1;
  }
  EXPECT_GT(refused, 5);
  EXPECT_TRUE(monitor.events().empty());
  std::cout << refused << " allocations refused in turn\n";
}

}  // namespace
}  // namespace cairn::faults
