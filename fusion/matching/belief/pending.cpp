// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/belief/pending.hpp"

#include <algorithm>
#include <utility>

#include "fusion/matching/belief/guess.hpp"
#include "fusion/matching/evidence/acceptance.hpp"

namespace cairn::matching {
namespace {

bool contradicts(const Evidence& e, const BeliefConfig& config) {
  return e.conflict + e.reverse_conflict > config.contradicted;
}

bool on_new_ground(const Hypothesis& h, const Evidence& e, const BeliefConfig& config) {
  const double more_m2 = std::max(config.new_ground_m2, config.new_ground_share * h.ground_m2);
  return ground_m2(e, config) >= std::max(config.least_ground_m2, h.ground_m2 + more_m2);
}

/// An order by what the looks are and nothing else: equal rounds then give equal answers, in
/// whatever order they came.
bool before(const Look& x, const Look& y) {
  if (x.evidence.score != y.evidence.score) return x.evidence.score > y.evidence.score;
  const Vector6 a = x.T_a_b.mean.xyz_rpy(), b = y.T_a_b.mean.xyz_rpy();
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// The looks at different places, best first. Each has its uniqueness against its best rival.
std::vector<Look> rivals(std::vector<Look> looks) {
  std::sort(looks.begin(), looks.end(), before);
  std::vector<Look> places;
  for (const Look& look : looks) {
    const auto same = [&](const Look& other) { return same_place(other.T_a_b.mean, look.T_a_b.mean); };
    if (std::none_of(places.begin(), places.end(), same)) places.push_back(look);
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double own = places[i].evidence.score;
    const double rival = places.size() < 2 ? 0 : places[i == 0 ? 1 : 0].evidence.score;
    places[i].evidence.uniqueness = own > 0 ? std::clamp(1 - rival / own, 0.0, 1.0) : 0;
  }
  return places;
}

void drop(Hypothesis& h, const std::string& why) {
  h.earned = h.earned || h.standing == Standing::kAccepted;
  h.standing = Standing::kDropped;
  h.reason = "dropped: " + why;
}

void suspend(Hypothesis& h, const std::string& why) {
  h.earned = h.earned || h.standing == Standing::kAccepted;
  h.standing = Standing::kPending;
  h.agreements = 0;
  h.rivalled = true;
  h.reason = why;
}

/// Agreements that a look on new ground adds. A certain one counts twice, but no look decides
/// alone.
int weight_of(const Hypothesis& h, int needed, const BeliefConfig& config) {
  const int weight = h.probability_correct >= config.certain ? 2 : 1;
  return h.agreements > 0 ? weight : std::min(weight, needed - 1);
}

std::string so_often(const Hypothesis& h, int needed) {
  return (h.earned ? "agreed again " : "agreed on new ground ") + std::to_string(std::min(h.agreements, needed)) +
         " of " + std::to_string(needed) + " times";
}

/// How many agreements it takes, by what a guess says of the place.
int needed(const std::optional<UncertainPose>& guess, const SE3& T_a_b, const BeliefConfig& config) {
  if (!guess) return config.agreements;
  if (!agrees(*guess, T_a_b)) return config.agreements + 1;
  // Odds that an agreement is of a wrong place.
  const double chance_of_one = (1 - config.agrees) / config.agrees;
  return chance_agreement(*guess) + kWrongGuess <= chance_of_one ? config.agreements - 1 : config.agreements;
}

/// Whether the guess leaves a place at T, but not its rival at T_rival.
bool excludes(const std::optional<UncertainPose>& guess, const SE3& T_rival, const SE3& T) {
  return guess && !agrees(*guess, T_rival) && agrees(*guess, T);
}

/// The probability of a rival, where a guess excludes it.
double discounted(double probability) {
  return kWrongGuess * probability / (1 - probability + kWrongGuess * probability);
}

/// What one round says of a place beside its look.
struct Verdict {
  Decision now{};
  double alone = 0;                      // its probability if there were no other place
  double rival = 0;                      // the probability of the likeliest other place, discounted
  bool copied = false, outdone = false;  // by another credible place
  int needed = 0;
};

double conflict_of(const Look& look, const BeliefConfig& config) {
  return std::max(config.least_conflict, look.evidence.conflict + look.evidence.reverse_conflict);
}

Decision decide_alone(Evidence evidence, const AcceptanceConfig& config) {
  evidence.uniqueness = 1;
  return decide(evidence, config);
}

/// What the other places say of each.
std::vector<Verdict> verdicts(const std::vector<Look>& places, const std::optional<UncertainPose>& guess,
                              const BeliefConfig& config, const AcceptanceConfig& acceptance) {
  std::vector<Verdict> all;
  for (const Look& look : places)
    all.push_back({.now = decide(look.evidence, acceptance),
                   .alone = decide_alone(look.evidence, acceptance).probability_correct,
                   .needed = needed(guess, look.T_a_b.mean, config)});
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double own_conflict = conflict_of(places[i], config);
    for (std::size_t j = 0; j < places.size(); ++j) {
      if (j == i) continue;
      const bool excluded = excludes(guess, places[j].T_a_b.mean, places[i].T_a_b.mean);
      const double p = all[j].now.probability_correct, conflict = conflict_of(places[j], config);
      all[i].rival = std::max(all[i].rival, excluded ? discounted(p) : p);
      if (all[j].alone < config.credible) continue;
      // What a guess excludes must do better.
      all[i].copied |= conflict < (excluded ? 1 : config.told_apart) * own_conflict;
      all[i].outdone |= conflict < (excluded ? 1 : config.outdone) * own_conflict;
    }
  }
  return all;
}

void judge(Hypothesis& h, const Look& look, const Verdict& verdict, const BeliefConfig& config) {
  const Decision& now = verdict.now;
  h.T_a_b = look.T_a_b;
  h.evidence = look.evidence;
  h.probability_correct = now.probability_correct;
  h.contradictions = contradicts(look.evidence, config) ? h.contradictions + 1 : 0;
  h.rivalled = verdict.rival >= config.rivalled || verdict.copied;
  if (h.contradictions >= config.contradictions) return drop(h, now.reason);
  if (h.standing == Standing::kAccepted) {
    if (verdict.rival >= config.overthrown || verdict.outdone) suspend(h, "another pose has become likely");
    return;
  }
  const int needed = verdict.needed;
  const bool agrees = h.probability_correct >= config.agrees && !h.rivalled;
  h.reason = agrees           ? so_often(h, needed)
             : verdict.copied ? "the place could be a copy of another one"
             : h.rivalled     ? "another pose may be as good"
                              : now.reason;
  if (h.earned && !agrees) h.agreements = 0;
  if (!agrees || !(h.earned || on_new_ground(h, look.evidence, config))) return;
  h.ground_m2 = std::max(h.ground_m2, ground_m2(look.evidence, config));
  h.agreements += weight_of(h, needed, config);
  h.reason = so_often(h, needed);
  if (h.agreements >= needed) h.standing = Standing::kAccepted;
}

}  // namespace

double ground_m2(const Evidence& evidence, const BeliefConfig& config) {
  return std::max(evidence.agreeing_m2, config.ground_of_floor * evidence.agreeing_floor_m2);
}

Hypothesis& PendingHypotheses::held_or_new(const SE3& T_a_b) {
  const auto it = std::find_if(all_.begin(), all_.end(), [&](const Hypothesis& h) {
    return h.standing != Standing::kDropped && same_place(h.T_a_b.mean, T_a_b);
  });
  if (it != all_.end()) return *it;
  const auto again = std::find_if(all_.begin(), all_.end(),
                                  [&](const Hypothesis& h) { return h.earned && same_place(h.T_a_b.mean, T_a_b); });
  if (again == all_.end()) return all_.emplace_back();
  again->standing = Standing::kPending;
  again->agreements = again->contradictions = 0;
  return *again;
}

void PendingHypotheses::take(std::vector<Look> looks, const std::optional<UncertainPose>& guess) {
  const auto places = rivals(std::move(looks));
  const auto all = verdicts(places, guess, config_, acceptance_);
  for (std::size_t i = 0; i < places.size(); ++i) judge(held_or_new(places[i].T_a_b.mean), places[i], all[i], config_);
  allow_one();
  put_in_order();
}

void PendingHypotheses::allow_one() {
  const auto accepted = [](const Hypothesis& h) { return h.standing == Standing::kAccepted; };
  if (std::count_if(all_.begin(), all_.end(), accepted) < 2) return;
  for (Hypothesis& h : all_)
    if (accepted(h)) suspend(h, "two places agree, one of them must be wrong");
}

void PendingHypotheses::put_in_order() {
  const auto rank = [](const Hypothesis& h) {
    return std::pair(h.standing == Standing::kAccepted  ? 0
                     : h.standing == Standing::kPending ? 1
                                                        : 2,
                     h.standing == Standing::kDropped ? 0 : -h.probability_correct);
  };
  std::stable_sort(all_.begin(), all_.end(), [&](const auto& x, const auto& y) { return rank(x) < rank(y); });
  const auto dropped = [](const Hypothesis& h) { return h.standing == Standing::kDropped; };
  auto forgotten = std::count_if(all_.begin(), all_.end(), dropped) - static_cast<std::ptrdiff_t>(kMostDropped);
  std::size_t pending = 0;
  std::erase_if(all_, [&](const Hypothesis& h) {
    return dropped(h) ? forgotten-- > 0 : h.standing == Standing::kPending && ++pending > kMostPending;
  });
}

std::vector<SE3> PendingHypotheses::places() const {
  std::vector<SE3> out;
  for (const Hypothesis& h : all_)
    if (h.standing != Standing::kDropped) out.push_back(h.T_a_b.mean);
  return out;
}

const Hypothesis* PendingHypotheses::accepted() const {
  return !all_.empty() && all_.front().standing == Standing::kAccepted ? &all_.front() : nullptr;
}

}  // namespace cairn::matching
