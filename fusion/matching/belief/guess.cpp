// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/belief/guess.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace cairn::matching {
namespace {

constexpr double kLargestSigmaM = 20.0 / 3;  // see PriorModes::near()
constexpr double kNearest99 = 16.81;         // χ² of 6 degrees of freedom
constexpr double kNearest99Of2 = 9.21, kNearest99Of1 = 2.576;
constexpr double kPlacesWithinM = 10, kHeadings = 4;

double largest_sigma_m(const UncertainPose& guess) { return std::sqrt(guess.covariance.diagonal().head<2>().sum()); }

}  // namespace

bool worth_following(const UncertainPose& guess) { return largest_sigma_m(guess) <= kLargestSigmaM; }

double squared_deviation(const UncertainPose& guess, const SE3& T_a_b) {
  const SE3 off = guess.mean.inverse() * T_a_b;
  Vector6 xi;
  xi << off.translation(), SE3(off.quaternion(), Eigen::Vector3d::Zero()).log().tail<3>();
  return xi.dot(guess.covariance.ldlt().solve(xi));
}

bool agrees(const UncertainPose& guess, const SE3& T_a_b) { return squared_deviation(guess, T_a_b) <= kNearest99; }

double chance_agreement(const UncertainPose& guess) {
  const double ellipse = std::sqrt(std::max(0.0, guess.covariance.topLeftCorner<2, 2>().determinant()));
  const double place = kNearest99Of2 * ellipse / (kPlacesWithinM * kPlacesWithinM);
  const double half_turn = kNearest99Of1 * std::sqrt(guess.covariance(5, 5));
  const double turn = std::max(1 / kHeadings, half_turn / std::numbers::pi);
  return std::min(1.0, place) * std::min(1.0, turn);
}

}  // namespace cairn::matching
