// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fusion/matching/evidence/judge.hpp"

namespace cairn::matching {

enum class Standing { kPending, kAccepted, kDropped };

/// One place where map b may lie in map a, and what is held for and against it so far.
struct Hypothesis {
  UncertainPose T_a_b;             ///< of the newest look
  Evidence evidence;               ///< of the newest look; unique among all that was looked at with it
  double probability_correct = 0;  ///< within 0.6 m and 6° of the truth, by the newest look
  Standing standing = Standing::kPending;
  std::string reason;      ///< of its standing, for people
  int agreements = 0;      ///< looks that agreed, each on new ground; those that are all but certain count twice
  double ground_m2 = 0;    ///< structure that agreed at the last of them
  bool earned = false;     ///< has been accepted once, on ground that was new then
  int contradictions = 0;  ///< looks in a row that did not
  bool rivalled = false;   ///< at the newest look another place was too likely to decide for this one
};

/// Where one map may lie in another while both grow. No single comparison decides: a hypothesis is accepted when it has
/// agreed three times, or twice if one of them was all but certain, each time on new ground and while no other place
/// was at all likely; it is dropped when the maps contradict it twice in a row, and an accepted one is suspended when
/// another place becomes likely. What was accepted once has shown itself on new ground: it is accepted again after as
/// many agreements in a row on any, so that maps that do not grow any more can still come together. Where geometry
/// repeats, rivals are as good as each other and none is accepted, until something tells them apart. A guess of the
/// pose counts as one agreement where that is as unlikely by chance, against a place that it excludes as one, and makes
/// likely rivals that it excludes less so by the odds that the guess is wrong: a copy of the place that fits as well as
/// itself still keeps both pending. A pure function of the rounds it was given; within a round the order of the looks
/// does not matter. The rules were chosen on the seeds that decide() was fitted on; tests/bench/matching_missions
/// measures them on others.
class PendingHypotheses {
 public:
  static constexpr std::size_t kMostPending = 6, kMostDropped = 6;

  /// One round: a look at every place that was compared while the maps stood still. What is held but was not looked at
  /// stays as it is. `guess`: see guess.hpp.
  void take(std::vector<Look> looks, const std::optional<UncertainPose>& guess = {});

  /// The accepted one, then pending by falling probability, then dropped, oldest first.
  [[nodiscard]] std::span<const Hypothesis> all() const { return all_; }
  /// Those to look at again: accepted and pending.
  [[nodiscard]] std::vector<SE3> places() const;
  /// Nothing while none is.
  [[nodiscard]] const Hypothesis* accepted() const;

 private:
  [[nodiscard]] Hypothesis& held_or_new(const SE3& T_a_b);
  void allow_one();
  void put_in_order();

  std::vector<Hypothesis> all_;
};

}  // namespace cairn::matching
