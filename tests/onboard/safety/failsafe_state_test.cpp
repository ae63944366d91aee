// SPDX-License-Identifier: Apache-2.0
// The failsafe's laws over every combination of faults and every state: nothing is sampled.
#include "onboard/safety/failsafe_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <set>
#include <tuple>
#include <vector>

#include "onboard/safety/failsafe.hpp"

namespace cairn::safety {
namespace {

constexpr std::uint32_t kSets = 1U << kFaults;
constexpr std::array kStates{Latch::State::kRunning, Latch::State::kStopped, Latch::State::kArming};

FaultPolicy usual() { return Failsafe(FailsafeConfig{}, {}).policy(); }

TEST(FailsafeState, EveryCombinationOfFaultsGivesTheWorstActiveMode) {
  const FaultPolicy policy = usual();
  std::uint64_t wrong = policy.demanded_by({}) != Mode::kNormal ? 1U : 0U;
  // Each set against itself without its first fault: by induction the mode of a set is the worst of its faults' own,
  // and one more fault never gives a milder one.
  for (std::uint32_t set = 1; set < kSets; ++set) {
    const Mode alone = fault_table()[static_cast<std::size_t>(std::countr_zero(set))].usual;
    const Mode others = policy.demanded_by(FaultSet(set & (set - 1)));
    wrong += policy.demanded_by(FaultSet(set)) != std::max(alone, others) ? 1U : 0U;
  }
  EXPECT_EQ(wrong, 0U);
}

TEST(FailsafeState, InEveryStateWithEveryCombinationMotionNeedsThatNothingStops) {
  const FaultPolicy policy = usual();
  std::uint64_t wrong = 0, sets_that_stop = 0, combinations = 0;
  for (const bool stop : {false, true})
    for (const Latch::State state : kStates)
      for (const bool guard : {false, true})
        for (const auto& request : {std::optional<std::uint32_t>{}, {7U}, {6U}}) {
          const Latch next = Latch{state, 7}.next({stop, guard, request});
          const bool runs = next.state == Latch::State::kRunning, arms = next.state == Latch::State::kArming;
          wrong += runs != (!stop && !guard && state != Latch::State::kStopped) ? 1U : 0U;
          wrong += arms != (!stop && request == 7U && state == Latch::State::kStopped) ? 1U : 0U;
          wrong += next.epoch != (arms ? 8U : 7U) ? 1U : 0U;
          ++combinations;
        }
  for (std::uint32_t set = 0; set < kSets; ++set)
    sets_that_stop += policy.demanded_by(FaultSet(set)) == Mode::kStop ? 1U : 0U;
  EXPECT_EQ(wrong, 0U);
  // All but the subsets of the faults that do not stop.
  EXPECT_EQ(sets_that_stop, kSets - (1U << (kFaults - static_cast<unsigned>(std::popcount(policy.stop.bits())))));
  std::cout << kSets << " sets of faults x " << combinations / 2
            << " of state, guard and request = " << kSets * (combinations / 2) << " combinations, of which "
            << sets_that_stop * (combinations / 2) << " stop\n";
}

TEST(FailsafeState, AWorseModeForAFaultNeverGivesAMilderMode) {
  FaultPolicy policy = usual();
  for (const FaultRow& row : fault_table()) {
    FaultPolicy worse = policy;
    worse.degrade.set(row.fault, false);
    worse.hold.set(row.fault, false);
    worse.stop.set(row.fault);
    for (std::uint32_t a = 0; a < kFaults; ++a)
      for (std::uint32_t b = 0; b < kFaults; ++b) {
        const FaultSet set{row.fault, static_cast<Fault>(a), static_cast<Fault>(b)};
        EXPECT_GE(worse.demanded_by(set), policy.demanded_by(set));
      }
  }
}

TEST(FailsafeState, TheCauseIsActiveAndDemandsTheMode) {
  const FaultPolicy policy = usual();
  std::uint64_t wrong = 0;
  for (std::uint32_t set = 0; set < kSets; ++set) {
    const auto cause = policy.worst_of(FaultSet(set));
    const Mode mode = policy.demanded_by(FaultSet(set));
    if (mode == Mode::kNormal)
      wrong += cause ? 1U : 0U;
    else
      wrong += !cause || !FaultSet(set).has(*cause) || policy.demanded_by({*cause}) != mode ? 1U : 0U;
  }
  EXPECT_EQ(wrong, 0U);
}

/// A node of the search: the latch, and whether a granted request lies between the last stop and now.
struct Node {
  Latch latch;
  bool granted = false;
  friend bool operator<(const Node& a, const Node& b) {
    return std::tie(a.latch.state, a.latch.epoch, a.granted) < std::tie(b.latch.state, b.latch.epoch, b.granted);
  }
};

TEST(FailsafeState, NoPathLeadsFromAStopToMotionWithoutARequestThatNamesThatStop) {
  constexpr std::uint32_t kEpochs = 5;
  std::set<Node> seen;
  std::vector<Node> open{{Latch{}, false}};
  std::uint64_t edges = 0;
  while (!open.empty()) {
    const Node node = open.back();
    open.pop_back();
    if (!seen.insert(node).second || node.latch.epoch >= kEpochs) continue;
    for (const bool stop : {false, true})
      for (const bool guard : {false, true})
        for (std::uint32_t request = 0; request <= kEpochs; ++request) {  // kEpochs: none
          const auto rearm = request == kEpochs ? std::nullopt : std::optional(request);
          const Latch next = node.latch.next({stop, guard, rearm});
          const bool grants = node.latch.state == Latch::State::kStopped && !stop && request == node.latch.epoch;
          const bool granted = !stop && (grants || (node.granted && next.state != Latch::State::kStopped));
          if (next.state == Latch::State::kRunning) {
            EXPECT_TRUE(granted);
            EXPECT_FALSE(stop || guard);
          }
          open.push_back({next, granted});
          ++edges;
        }
  }
  EXPECT_TRUE(seen.count({Latch{Latch::State::kRunning, 1}, true})) << "with the request it does run";
  std::cout << seen.size() << " states, " << edges << " transitions searched\n";
}

}  // namespace
}  // namespace cairn::safety
