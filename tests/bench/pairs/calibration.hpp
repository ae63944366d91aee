// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace cairn::pairs {

/// One answer: how much it counts, the probability that it gave, and whether it was right.
struct Judged {
  double weight = 1, p = 0;
  bool right = false;
};

/// How far probabilities are from what happened.
struct Calibration {
  /// Expected calibration error (ECE): answers are sorted into ten bins by their probability. It is the mean distance
  /// between the mean probability of a bin and the share in it that was right.
  double error = 0;
  /// The error of the same answers if each was right with exactly the probability that it gave: the mean, and what one
  /// draw of twenty exceeds. An error below that shows nothing. Answers count as independent. Those about one pair are
  /// not, so both are a little too low.
  double by_chance = 0, rarely_over = 0;
};

/// Gives the same for the same answers.
[[nodiscard]] Calibration calibration(std::span<const Judged> answers);

}  // namespace cairn::pairs
