// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/start_search.hpp"

#include "onboard/odometry/estimation/gap_search.hpp"

namespace cairn::odometry {
namespace {

// Scans per map. In a corridor the speed stays unknown for ever: what the first scans cannot tell,
// later ones cannot either.
constexpr int kSpeedGuesses = 3;
// A speed that is off by half a step moves the base by 0.05 m in a scan of 0.1 s: a tenth of the
// default speed_gate_m.
constexpr double kSpeedStep_m_s = 1.0;
// Times initial_speed, the speed's standard deviation: 95 of 100 speeds are slower.
constexpr double kSpeedSigmas = 2.0;
// Keypoints that another speed must fit, as a multiple of those that rest fits. Where all speeds
// look alike (in an endless corridor), rest is the best guess.
constexpr double kBetterThanRest = 1.1;

// Indices of the error state (δ, ν).
constexpr int kDeltaX = 0, kDeltaYaw = 5, kNuX = 6;

bool unknown(const MotionFilter& filter, int index, double sigma) {
  return filter.uncertainty().local(index, index) > sigma * sigma;
}

MotionState faster(const MotionState& predicted, double speed_m_s, double dt_s) {
  Vector12 change = Vector12::Zero();
  change[kDeltaX] = dt_s * speed_m_s;
  change[kNuX] = speed_m_s;
  return predicted + change;
}

}  // namespace

StartSearch::StartSearch(const OdometryConfig& config)
    : config_(config.start_search), fastest_m_s_(kSpeedSigmas * config.initial_speed) {}

void StartSearch::begin_map() { speed_guesses_left_ = kSpeedGuesses; }

MotionState StartSearch::find(const MotionFilter& filter, double dt_s, const Score& score) {
  if (speed_guesses_left_ == 0 || !unknown(filter, kNuX, config_.unknown_speed_m_s)) return filter.state();
  --speed_guesses_left_;
  return guess_speed(filter.state(), dt_s, score);
}

MotionState StartSearch::find_restarted(const MotionFilter& filter, double dt_s, const Score& score) const {
  if (!unknown(filter, kDeltaYaw, config_.unknown_heading_rad)) return filter.state();
  return search_after_gap(filter.state(), filter.uncertainty().local, dt_s,
                          [&](const MotionState& hypothesis) { return score(hypothesis, config_.gap_gate_m); });
}

MotionState StartSearch::guess_speed(const MotionState& predicted, double dt_s, const Score& score) const {
  MotionState best = predicted;
  double most = kBetterThanRest * score(predicted, config_.speed_gate_m);
  for (double speed = kSpeedStep_m_s; speed <= fastest_m_s_; speed += kSpeedStep_m_s) {
    for (const double v : {speed, -speed}) {
      const MotionState hypothesis = faster(predicted, v, dt_s);
      const double fits = score(hypothesis, config_.speed_gate_m);
      if (fits > most) {
        most = fits;
        best = hypothesis;
      }
    }
  }
  return best;
}

}  // namespace cairn::odometry
