// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/delay_filter.hpp"

#include <utility>

namespace cairn::velodyne {

void DelayFilter::begin(Duration sample, Duration offset, Time arrival) {
  offset_ = offset;
  window_min_ = previous_min_ = sample;
  window_start_ = since_ = arrival;
}

bool DelayFilter::add(Duration sample, Time arrival) {
  if (arrival - window_start_ < kWindow) {
    window_min_ = std::min(window_min_, sample);
    return false;
  }
  const bool late = window_min_ - offset_ > kMaxWindowError;
  previous_min_ = std::exchange(window_min_, sample);
  window_start_ = arrival;
  return late;
}

double DelayFilter::catch_up() const {
  const double late = to_seconds(offset_ - smallest()) / to_seconds(kCatchUp);
  return std::clamp(late, 0.0, 1.0 / kSteepest);
}

void DelayFilter::advance(Duration step, Time arrival, Duration most_back) {
  const Duration slew = step / (arrival - since_ < kWindow ? kFastSlew : kSlowSlew);
  const Duration back = std::max(slew, from_seconds(to_seconds(step) * catch_up()));
  offset_ += std::clamp(smallest() - offset_, -std::min(back, most_back), slew);
}

}  // namespace cairn::velodyne
