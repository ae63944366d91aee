// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/detector_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace cairn::cli {
namespace {

constexpr int kRounds = 50;
constexpr double kSame = 1e-9;

/// The log odds that a box is a person's: at + slope · (score − centre).
struct Line {
  double at = 0, slope = 0, slope_sigma = 0;
};

/// Newton's method. Platt's targets are inside of (0, 1), so that it ends also where the scores part the two kinds.
Line regress(std::span<const LookedAt> bodies, const DetectorFit& counts, double centre) {
  const double yes = (static_cast<double>(counts.people_boxed) + 1) / (static_cast<double>(counts.people_boxed) + 2);
  const double no = 1 / (static_cast<double>(counts.others_boxed) + 2);
  Eigen::Vector2d w = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    information = 1e-9 * Eigen::Matrix2d::Identity();
    for (const LookedAt& body : bodies) {
      if (!body.boxed) continue;
      const Eigen::Vector2d x(1, body.score - centre);
      const double p = 1 / (1 + std::exp(-w.dot(x)));
      gradient += ((body.person ? yes : no) - p) * x;
      information += p * (1 - p) * x * x.transpose();
    }
    const Eigen::Vector2d step = information.ldlt().solve(gradient);
    w += step * std::min(1.0, 5 / std::max(step.norm(), kSame));  // far from the end a whole step may overshoot
    if (step.norm() < kSame) break;
  }
  return {w[0], w[1], std::sqrt(information.inverse()(1, 1))};
}

double mean_score(std::span<const LookedAt> bodies) {
  double sum = 0;
  std::uint64_t n = 0;
  for (const LookedAt& body : bodies)
    if (body.person && body.boxed) sum += body.score, ++n;
  return sum / static_cast<double>(n);
}

DetectorFit count(std::span<const LookedAt> bodies) {
  DetectorFit fit;
  for (const LookedAt& body : bodies) {
    ++(body.person ? fit.people : fit.others);
    if (!body.boxed) continue;
    ++(body.person ? fit.people_boxed : fit.others_boxed);
    auto& bin = fit.boxes[std::min(static_cast<std::size_t>(body.score * DetectorFit::kBins), DetectorFit::kBins - 1)];
    ++(body.person ? bin.people : bin.others);
  }
  const auto share = [](std::uint64_t part, std::uint64_t whole) {
    return (static_cast<double>(part) + 1) / (static_cast<double>(whole) + 2);
  };
  fit.recall = share(fit.people_boxed, fit.people);
  fit.false_share = share(fit.others_boxed, fit.others);
  return fit;
}

}  // namespace

std::optional<DetectorFit> fit_detector(std::span<const LookedAt> bodies) {
  DetectorFit fit = count(bodies);
  if (fit.people < kFewestBodies || fit.others < kFewestBodies || fit.people_boxed == 0) return std::nullopt;
  const double centre = mean_score(bodies);
  fit.usual_score = centre;
  if (fit.people_boxed < kFewestBoxes || fit.others_boxed < kFewestBoxes) return fit;
  const Line line = regress(bodies, fit, centre);
  if (!(line.slope > 0)) return fit;
  fit.score_slope = line.slope;
  fit.slope_sigma = line.slope_sigma;
  // The regression knows how many bodies of each kind there are. Evidence must not.
  const double prior = std::log(static_cast<double>(fit.people) / static_cast<double>(fit.others));
  const double missing = std::log(fit.recall / fit.false_share) - (line.at - prior);
  fit.usual_score = std::clamp(centre + missing / line.slope, 0.0, 1.0);
  return fit;
}

}  // namespace cairn::cli
