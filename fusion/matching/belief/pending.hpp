// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fusion/matching/evidence/judge.hpp"

namespace cairn::matching {

/// Settings of PendingHypotheses. They were chosen on the seeds of tests/bench/matching_missions on
/// which decide() was fitted. The benchmark measures them on other seeds.
struct BeliefConfig {
  /// Agreements of an accepted hypothesis. With two on ample ground, the wrong half of a
  /// half-turned building was accepted in 2 of 6 missions.
  int agreements = 3;
  double agrees = 0.9;  ///< least probability of a look that agrees
  /// Least probability of one that counts twice. Of wrong looks only those at exact copies reach it:
  /// 1 of 298 in half-turned buildings, none of 792 elsewhere (tests/bench/matching_missions).
  double certain = 0.999;
  double least_ground_m2 = 60;  ///< ground that a look needs to agree, m²; see ground_m2()
  /// What a m² of floor over which structure agrees counts for at least, m² of structure.
  double ground_of_floor = 0.5;
  /// Ground that a look must add to the last agreement's, as a share and in m²: the larger of the
  /// two.
  double new_ground_share = 0.1, new_ground_m2 = 10;
  /// Share of structure in the other's free space from which on a look contradicts.
  double contradicted = 0.06;
  /// Looks in a row that contradict, after which a hypothesis is dropped.
  int contradictions = 2;
  double rivalled = 0.15;  ///< probability of another place from which on a look does not agree
  // Of copies: credible, told_apart and outdone were chosen on office teams of seeds 1 to 6.
  /// Another place is credible if its probability would be this without rivals, whatever its score is.
  /// A score grows with the overlap. So the truth may have a low one where robots saw different halves.
  double credible = 0.5;
  /// A credible place is no copy of this one if it has so many times the conflict. In the simulated
  /// office (seed 1), the truth had 1 to 2 times the conflict of the half-turned place that was merged.
  /// Half-turned places had 3.5 to 11 times that of right ones, where these were merged.
  double told_apart = 2.5;
  /// An accepted place is suspended if a credible one has less than so many times its conflict.
  double outdone = 1.5;
  double least_conflict = 0.004;  ///< what less conflict counts for; chosen by hand, not tuned
  /// Probability of another place from which on an accepted hypothesis is suspended. Two places that
  /// are equally good have just below 0.5 each.
  double overthrown = 0.4;
};

/// How much ground a look agrees on, m² of structure. A LiDAR sees walls up to their tops, so there
/// it is the structure that agrees. A camera that looks down sees as many places, but low parts of
/// them. There it is a share of the floor over which structure agrees.
[[nodiscard]] double ground_m2(const Evidence& evidence, const BeliefConfig& config = {});

/// Standing of a hypothesis.
enum class Standing { kPending, kAccepted, kDropped };

/// One place where map b may lie in map a, and what is known for and against it.
struct Hypothesis {
  UncertainPose T_a_b;  ///< of the newest look
  /// Of the newest look; its uniqueness is among all places of that round.
  Evidence evidence;
  double probability_correct = 0;  ///< within 0.6 m and 6° of the truth, by the newest look
  Standing standing = Standing::kPending;
  std::string reason;      ///< of its standing, for people
  int agreements = 0;      ///< looks that agreed, each on new ground; certain ones count twice
  double ground_m2 = 0;    ///< ground of the last of them, m²
  bool earned = false;     ///< it was accepted before, on ground that was new then
  int contradictions = 0;  ///< last looks in a row that contradicted
  bool rivalled = false;   ///< at the newest look another place was too likely to decide for this one
};

/// The places where one map may lie in another, while both grow. No single comparison decides.
/// - Accepted: a hypothesis that agreed three times, each time on new ground and while no other
///   place was likely. A certain look counts twice, but never decides alone.
/// - Dropped: one that the maps contradict twice in a row.
/// - Suspended: an accepted one, when another place becomes likely, or credible with little conflict.
/// - Accepted again: one that was accepted before, after as many agreements in a row on any ground.
///   So maps that do not grow any more can still come together.
///
/// Where geometry repeats, rivals are equally good, and none is accepted until something tells them
/// apart. A place with much less overlap is a rival, too, if it is credible by itself: only conflict
/// tells a copy from the truth.
///
/// A guess of the pose saves one agreement if it would hardly agree by chance. A place that
/// contradicts it needs one more. Rivals that contradict it become less likely, by the odds that
/// the guess is wrong. Two places that fit equally well stay pending all the same.
///
/// The state is a pure function of the rounds. The order of looks within a round does not matter.
class PendingHypotheses {
 public:
  /// Hypotheses that are kept, at most. Bounds on memory and time. Chosen by hand, not tuned.
  static constexpr std::size_t kMostPending = 6, kMostDropped = 6;

  /// `acceptance`: what looks are decided with; see decide().
  explicit PendingHypotheses(const BeliefConfig& config = {}, const AcceptanceConfig& acceptance = {})
      : config_(config), acceptance_(acceptance) {}

  /// Takes in one round: the looks at all places that were compared while the maps stood still.
  /// Hypotheses without a look stay as they are. `guess`: see guess.hpp.
  void take(std::vector<Look> looks, const std::optional<UncertainPose>& guess = {});

  /// The accepted one, then the pending by falling probability, then the dropped, oldest first.
  [[nodiscard]] std::span<const Hypothesis> all() const { return all_; }
  /// The places to look at again: of the accepted and the pending.
  [[nodiscard]] std::vector<SE3> places() const;
  /// Null if none is accepted. Valid until the next take().
  [[nodiscard]] const Hypothesis* accepted() const;

 private:
  [[nodiscard]] Hypothesis& held_or_new(const SE3& T_a_b);
  void allow_one();
  void put_in_order();

  BeliefConfig config_;
  AcceptanceConfig acceptance_;
  std::vector<Hypothesis> all_;
};

}  // namespace cairn::matching
