// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/device_time.hpp"

#include <algorithm>
#include <utility>

#include "drivers/velodyne/packet.hpp"

namespace cairn::velodyne {
namespace {

/// `step` plus that multiple of `modulus` that brings it nearest to `expected`.
std::int64_t unwrapped(std::int64_t step, std::int64_t modulus, std::int64_t expected) {
  const std::int64_t away = expected - step;
  const std::int64_t half = away < 0 ? -modulus / 2 : modulus / 2;
  return step + (away + half) / modulus * modulus;
}

}  // namespace

std::int64_t resolve_utc_us(std::uint32_t counter_us, std::int64_t reference_utc_us) {
  constexpr std::int64_t kHour = kMicrosecondsPerHour;
  const std::int64_t past_hour = ((reference_utc_us % kHour) + kHour) % kHour;
  std::int64_t utc = reference_utc_us - past_hour + counter_us;
  while (utc - reference_utc_us > kHour / 2) utc -= kHour;
  while (utc - reference_utc_us < -kHour / 2) utc += kHour;
  return utc;
}

DeviceTime::Stamp DeviceTime::update(std::uint32_t counter_us, Time arrival, Duration span, std::optional<Time> exact) {
  arrival = unbroken(arrival);
  const Duration step = started_ ? step_from_last(counter_us, arrival) : Duration{};
  const bool overlaps = started_ && step < busy_share(span_);
  if (overlaps && step >= -kReorderWindow && ++late_run_ <= kMaxLateRun)
    return {step == Duration{} ? Kind::kDuplicate : Kind::kLate, {}, step};
  late_run_ = 0;

  Time first_firing = arrival - span;
  if (exact) {
    const Duration gap = *exact + arrival_shift_ - first_firing;
    if (gap >= -kExactTolerance && gap <= kExactTolerance) first_firing += gap;
  }
  const Duration sample = first_firing.time_since_epoch() - (device_ + step);
  const Duration delay = sample - offset_;
  const bool jump = arrival_broken_ || overlaps || delay < -kMaxEarly || delay > kMaxDelay;
  const Kind kind = !started_ ? Kind::kFirst : jump || rotate_window(arrival, sample) ? Kind::kJump : Kind::kNext;
  counter_us_ = counter_us;
  arrival_ = started_ ? std::max(arrival_, arrival) : arrival;
  const Stamp stamp = kind == Kind::kNext ? (slew(step, arrival), Stamp{kind, last_first_firing(), step})
                                          : restart(kind, first_firing, arrival);
  span_ = span;
  return stamp;
}

/// The arrival on a line that never goes back by more than a queue can explain.
Time DeviceTime::unbroken(Time arrival) {
  arrival += arrival_shift_;
  arrival_broken_ = started_ && arrival < arrival_ - kMaxDelay;
  if (arrival_broken_) arrival_shift_ += arrival_ - std::exchange(arrival, arrival_);
  return arrival;
}

/// The counter wraps at the hour; seen in the field are sensors that pass it and wrap as u32.
Duration DeviceTime::step_from_last(std::uint32_t counter_us, Time arrival) const {
  const std::int64_t expected = (arrival - arrival_).count() / 1000;
  const std::int64_t raw = std::int64_t{counter_us} - std::int64_t{counter_us_};
  std::int64_t best = unwrapped(raw, kMicrosecondsPerHour, expected);
  if (counter_us_ >= kMicrosecondsPerHour) {
    const std::int64_t at_u32 = raw + (std::int64_t{1} << 32);
    for (const std::int64_t other : {raw, at_u32})
      if (std::abs(other - expected) < std::abs(best - expected)) best = other;
  }
  return std::chrono::microseconds(best);
}

DeviceTime::Stamp DeviceTime::restart(Kind kind, Time first_firing, Time arrival) {
  if (started_) first_firing = std::max(first_firing, last_first_firing() + span_);
  offset_ = first_firing.time_since_epoch() - device_;
  window_min_ = previous_min_ = offset_;
  window_start_ = offset_since_ = arrival;
  started_ = true;
  return {kind, first_firing, {}};
}

/// Adds a sample to the running window; true when the window that just ended was late as a whole.
bool DeviceTime::rotate_window(Time arrival, Duration sample) {
  if (arrival - window_start_ < kWindow) {
    window_min_ = std::min(window_min_, sample);
    return false;
  }
  const bool late = window_min_ - offset_ > kMaxWindowError;
  previous_min_ = std::exchange(window_min_, sample);
  window_start_ = arrival;
  return late;
}

/// Steps the device time and moves the offset towards the windows' minimum.
void DeviceTime::slew(Duration step, Time arrival) {
  const Duration earliest = busy_share(span_);
  const Duration limit = step / (arrival - offset_since_ < kWindow ? kFastSlew : kSlowSlew);
  const Duration wanted = std::min(previous_min_, window_min_) - offset_;
  device_ += step;
  offset_ += std::max(std::clamp(wanted, -limit, limit), earliest - step);
}

}  // namespace cairn::velodyne
