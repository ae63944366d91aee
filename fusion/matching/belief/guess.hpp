// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/se3.hpp"

// A guess of T_a_b that two maps are compared with: both robots' deployments, a GPS fix, a survey. Its covariance is of
// the right perturbation (m, rad). Guesses are right as a rule, and sometimes altogether wrong: nobody looks after
// them.
namespace cairn::matching {

/// The share of guesses that are altogether wrong.
inline constexpr double kWrongGuess = 0.05;

/// Whether a search near it covers three of its standard deviations, and finds more than a search without it.
[[nodiscard]] bool worth_following(const UncertainPose& guess);

/// χ² of a pose by the guess, 6 degrees of freedom: place and turn are taken one by one, so that a heading of which
/// nothing is known speaks against no place.
[[nodiscard]] double squared_deviation(const UncertainPose& guess, const SE3& T_a_b);
/// Whether a pose is one of the 99 % nearest to the guess.
[[nodiscard]] bool agrees(const UncertainPose& guess, const SE3& T_a_b);

/// The chance that a wrong pose agrees with the guess. Wrong poses are where something looks alike, in buildings the
/// next room, in one of four headings: those within 10 m are counted with, all places alike.
[[nodiscard]] double chance_agreement(const UncertainPose& guess);

}  // namespace cairn::matching
