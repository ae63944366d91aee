// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "onboard/perception/people/tracker.hpp"
#include "tests/onboard/perception/people/walkers.hpp"

namespace cairn::people::test {

using Eigen::Vector2d;

/// A tracker that is told clusters and verdicts one by one.
class TrackerTest : public ::testing::Test {
 protected:
  /// One scan with clusters at these places.
  void scan(const std::vector<Vector2d>& places) {
    now_ += kScan;
    clusters_.clear();
    for (const Vector2d& place : places)
      clusters_.push_back({.centre = place.cast<float>(),
                           .ground = ground_,
                           .top = 1.7F,
                           .extent = 0.5F,
                           .points = 40,
                           .entered = entered_,
                           .known = known_,
                           .upright = upright_,
                           .low = low_,
                           .passed = passed_});
    tracker_.predict(now_);
    tracker_.step(
        now_, clusters_, [this](const Vector2d&, std::span<const Vector2d>) { return beside_; },
        [this](const Track&) { return through_; }, [this](const Track&) { return empty_; });
  }
  /// Of the clusters; boxes have a good score.
  void hear(const std::vector<Verdict>& verdicts) {
    std::vector<Answer> answers;
    for (const Verdict verdict : verdicts) answers.push_back({verdict, 0.67F, 3});
    tracker_.hear(now_, answers, config_.visible);
  }

  PeopleConfig config_;
  Tracker tracker_{config_};
  Time now_{std::chrono::seconds(5)};
  std::vector<Cluster> clusters_;
  std::optional<Tracker::Beside> beside_;
  float ground_ = 0;
  bool through_ = false, empty_ = false;
  float entered_ = 0, known_ = 0;
  bool upright_ = false, low_ = false;
  float passed_ = 0;
};

}  // namespace cairn::people::test
