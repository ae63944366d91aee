// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/se3.hpp"

// A guess of T_a_b from outside of the maps: both robots' deployments, a GPS fix, a survey. Its
// covariance is of the right perturbation (m, rad). Most guesses are right, and some are altogether
// wrong.
namespace cairn::matching {

/// The share of guesses that are altogether wrong. Chosen by hand, not tuned.
inline constexpr double kWrongGuess = 0.05;

/// Whether a search near the guess covers three of its standard deviations. If not, a search
/// without the guess finds as much.
[[nodiscard]] bool worth_following(const UncertainPose& guess);

/// Squared deviation of a pose from the guess: χ² with 6 degrees of freedom. Place and turn are
/// compared one by one, so that an unknown heading does not count against any place.
[[nodiscard]] double squared_deviation(const UncertainPose& guess, const SE3& T_a_b);
/// Whether the guess agrees with a pose: it is within the 99 % bound of squared_deviation().
[[nodiscard]] bool agrees(const UncertainPose& guess, const SE3& T_a_b);

/// The chance that a wrong pose agrees with the guess, 0…1. Wrong poses are taken to lie anywhere
/// within a square of 10 m around the truth, in one of four headings: the next room of a building.
[[nodiscard]] double chance_agreement(const UncertainPose& guess);

}  // namespace cairn::matching
