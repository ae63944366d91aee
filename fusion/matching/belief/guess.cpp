// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/belief/guess.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fusion/matching/search/prior_modes.hpp"

namespace cairn::matching {
namespace {

constexpr double kChi2Of6 = 16.81;  // 99 % bound of χ² with 6 degrees of freedom
constexpr double kChi2Of2 = 9.21;   // the same with 2
constexpr double kNormal = 2.576;   // 99 % bound of a standard normal, both ways
// Edge of the square in which wrong poses lie. Chosen by hand, not tuned.
constexpr double kPlaces_m = 10;
constexpr double kHeadings = 4;  // of a wrong pose: buildings have right angles

double largest_sigma_m(const UncertainPose& guess) { return std::sqrt(guess.covariance.diagonal().head<2>().sum()); }

}  // namespace

bool worth_following(const UncertainPose& guess) {
  constexpr CoarseSearchConfig kSearch;  // what it can cover
  return largest_sigma_m(guess) <= kSearch.most_xy_m / kSearch.sigmas;
}

double squared_deviation(const UncertainPose& guess, const SE3& T_a_b) {
  const SE3 off = guess.mean.inverse() * T_a_b;
  Vector6 xi;
  xi << off.translation(), SE3(off.quaternion(), Eigen::Vector3d::Zero()).log().tail<3>();
  return xi.dot(guess.covariance.ldlt().solve(xi));
}

bool agrees(const UncertainPose& guess, const SE3& T_a_b) { return squared_deviation(guess, T_a_b) <= kChi2Of6; }

double chance_agreement(const UncertainPose& guess) {
  const double ellipse = std::sqrt(std::max(0.0, guess.covariance.topLeftCorner<2, 2>().determinant()));
  const double place = kChi2Of2 * ellipse / (kPlaces_m * kPlaces_m);
  const double half_turn = kNormal * std::sqrt(guess.covariance(5, 5));
  const double turn = std::max(1 / kHeadings, half_turn / std::numbers::pi);
  return std::min(1.0, place) * std::min(1.0, turn);
}

}  // namespace cairn::matching
