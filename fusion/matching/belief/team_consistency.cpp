// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/belief/team_consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace cairn::matching {
namespace {

// All chosen by hand, not tuned.
constexpr double kLoopWorth = 4;  // log-odds that a closed loop adds: of 0.98
// Standard deviations of the error between two maps that is due to odometry in each.
constexpr double kBend_m = 0.15, kBend_rad = 0.026;
// Probabilities: no claim counts more or less.
constexpr double kMostCertain = 0.999, kLeastCertain = 0.001;

double log_odds(double p) {
  const double bounded = std::clamp(p, kLeastCertain, kMostCertain);
  return std::log(bounded / (1 - bounded));
}

/// Chooses among claims by branch and bound: each with and without, the surest first.
class Chooser {
 public:
  explicit Chooser(std::vector<Claim> surest_first) : claims_(std::move(surest_first)) {
    double rest = 0;
    most_left_.resize(claims_.size() + 1, 0);
    for (std::size_t i = claims_.size(); i-- > 0;)
      most_left_[i] = rest += std::max(0.0, log_odds(claims_[i].probability) + kLoopWorth);
    choose(0, 0);
  }
  [[nodiscard]] const std::vector<std::size_t>& best() const { return best_; }
  /// The claims along the shortest way between two robots; empty if there is none.
  [[nodiscard]] std::vector<std::size_t> way(const std::vector<std::size_t>& among, int from, int to) const;
  [[nodiscard]] const Claim& claim(std::size_t i) const { return claims_[i]; }

 private:
  // NOLINTNEXTLINE(misc-no-recursion): as deep as there are claims, 16 at most
  void choose(std::size_t i, double worth) {
    if (worth > best_worth_) {
      best_worth_ = worth;
      best_ = chosen_;
    }
    if (i == claims_.size() || worth + most_left_[i] <= best_worth_) return;
    const Claim& c = claims_[i];
    const auto loop = way(chosen_, c.a, c.b);
    // Of two claims about one pair, one is wrong or they are the same.
    if (c.a != c.b && loop.size() != 1 && (loop.empty() || closes(loop, c))) {
      chosen_.push_back(i);
      choose(i + 1, worth + log_odds(c.probability) + (loop.empty() ? 0 : kLoopWorth));
      chosen_.pop_back();
    }
    choose(i + 1, worth);
  }
  [[nodiscard]] bool closes(const std::vector<std::size_t>& loop, const Claim& last) const;

  std::vector<Claim> claims_;
  std::vector<double> most_left_;  // worth of the claims from i on, at most
  std::vector<std::size_t> chosen_, best_;
  double best_worth_ = 0;
};

std::vector<std::size_t> Chooser::way(const std::vector<std::size_t>& among, int from, int to) const {
  struct Step {
    int robot;
    std::size_t before, claim;
  };
  std::vector<Step> reached{{.robot = from, .before = 0, .claim = 0}};
  for (std::size_t at = 0; at < reached.size(); ++at) {
    if (reached[at].robot == to) {
      std::vector<std::size_t> back;
      for (; at != 0; at = reached[at].before) back.push_back(reached[at].claim);
      std::reverse(back.begin(), back.end());
      return back;
    }
    for (const std::size_t i : among) {
      const Claim& c = claims_[i];
      if (c.a != reached[at].robot && c.b != reached[at].robot) continue;
      const int next = c.a == reached[at].robot ? c.b : c.a;
      const bool known = std::any_of(reached.begin(), reached.end(), [&](const Step& s) { return s.robot == next; });
      if (!known) reached.push_back({.robot = next, .before = at, .claim = i});
    }
  }
  return {};
}

bool Chooser::closes(const std::vector<std::size_t>& loop, const Claim& last) const {
  UncertainPose along;
  int at = last.a;
  for (const std::size_t i : loop) {
    const Claim& c = claims_[i];
    along = compose(along, bent(c.a == at ? c.T_a_b : inverse(c.T_a_b)));
    at = c.a == at ? c.b : c.a;
  }
  const UncertainPose around = compose(inverse(along), bent(last.T_a_b));
  return distance2(around.mean.log(), around.covariance) < kChi2;
}

}  // namespace

UncertainPose bent(const UncertainPose& pose) {
  Vector6 sigma;
  sigma << kBend_m, kBend_m, kBend_m, kBend_rad, kBend_rad, kBend_rad;
  return {pose.mean, pose.covariance + Matrix6(sigma.cwiseAbs2().asDiagonal())};
}

double distance2(const Vector6& error, const Matrix6& covariance) { return error.dot(covariance.ldlt().solve(error)); }

Agreement agreement_of(std::span<const Claim> claims) {
  Agreement out{std::vector<bool>(claims.size(), false), std::vector<int>(claims.size(), 0)};
  std::vector<std::size_t> order(claims.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return claims[i].probability > claims[j].probability; });
  order.resize(std::min(order.size(), kMostClaims));
  std::vector<Claim> surest_first;
  for (const std::size_t i : order) surest_first.push_back(claims[i]);
  const Chooser chooser(std::move(surest_first));
  std::vector<std::size_t> chosen;
  for (const std::size_t i : chooser.best()) {
    const Claim& c = chooser.claim(i);
    const auto loop = chooser.way(chosen, c.a, c.b);
    for (const std::size_t k : loop) ++out.closed[order[k]];
    out.closed[order[i]] += loop.empty() ? 0 : 1;
    out.kept[order[i]] = true;
    chosen.push_back(i);
  }
  return out;
}

}  // namespace cairn::matching
