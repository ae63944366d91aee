// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/device_time.hpp"

#include <algorithm>

#include "drivers/velodyne/packet.hpp"

namespace cairn::velodyne {
namespace {

/// `step` plus that multiple of `modulus` that brings it nearest to `expected`.
std::int64_t unwrapped(std::int64_t step, std::int64_t modulus, std::int64_t expected) {
  const std::int64_t away = expected - step;
  const std::int64_t half = away < 0 ? -modulus / 2 : modulus / 2;
  return step + (away + half) / modulus * modulus;
}

/// Up to here the offset is reduced in the pause at a packet's end.
constexpr double kEvenSlew = 1.0 / 64;

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
  arrival += arrival_shift_;
  Time first_firing = arrival - span;
  if (exact) {
    const Duration gap = *exact + arrival_shift_ - first_firing;
    if (gap >= -kExactTolerance && gap <= kExactTolerance) first_firing += gap;
  }
  const Duration step = started_ ? step_from_last(counter_us, arrival) : Duration{};
  const Duration sample = first_firing.time_since_epoch() - (device_ + step);
  const Kind kind = judge(step, arrival, sample);
  if (kind == Kind::kDuplicate || kind == Kind::kLate || kind == Kind::kAhead) return {kind, {}, step};
  counter_us_ = counter_us;
  if (kind != Kind::kNext) restart(kind, arrival, sample + step);
  span_ = span;
  if (kind == Kind::kNext) return follow(step, arrival);
  busy_ = busy_share(span_);
  return {kind, last_first_firing(), {}, 1.0};
}

/// The counter wraps at the hour; seen in the field are sensors that pass it and wrap as u32. A counter that goes on
/// evenly is believed whatever arrival says.
Duration DeviceTime::step_from_last(std::uint32_t counter_us, Time arrival) const {
  const std::int64_t raw = std::int64_t{counter_us} - std::int64_t{counter_us_};
  for (const std::int64_t even : {raw, raw + kMicrosecondsPerHour})
    if (even > 0 && std::chrono::microseconds(even) <= kContinuous) return std::chrono::microseconds(even);
  const std::int64_t expected = (arrival - arrival_).count() / 1000;
  std::int64_t best = unwrapped(raw, kMicrosecondsPerHour, expected);
  if (counter_us_ >= kMicrosecondsPerHour) {
    const std::int64_t at_u32 = raw + (std::int64_t{1} << 32);
    for (const std::int64_t other : {raw, at_u32})
      if (std::abs(other - expected) < std::abs(best - expected)) best = other;
  }
  return std::chrono::microseconds(best);
}

/// What the packet is. A packet that is used gives the filter its sample.
DeviceTime::Kind DeviceTime::judge(Duration step, Time arrival, Duration sample) {
  if (!started_) return Kind::kFirst;
  if (const auto why = contradiction(step, arrival, sample)) return ++set_aside_ <= kMaxSetAside ? *why : Kind::kJump;
  set_aside_ = 0;
  if (may_begin_again_ && sample < delay_.offset() - kQueueDrains) return Kind::kFirst;
  if (step > kContinuous) stepped_ = true;
  if (sample - delay_.offset() < DelayFilter::kMaxWindowError) stepped_ = false;
  return delay_.add(sample, arrival) && stepped_ ? Kind::kJump : Kind::kNext;
}

std::optional<DeviceTime::Kind> DeviceTime::contradiction(Duration step, Time arrival, Duration sample) const {
  if (step == Duration{}) return Kind::kDuplicate;
  if (step < busy_share(span_) || arrival < arrival_ - kMaxDelay) return Kind::kLate;
  if (step > kContinuous && sample < delay_.smallest() - kMaxEarly) return Kind::kAhead;
  return std::nullopt;
}

/// `sample`: of a device time that has made no step.
void DeviceTime::restart(Kind kind, Time arrival, Duration sample) {
  if (started_ && arrival < arrival_ - kMaxDelay) {
    const Duration back = arrival_ - arrival;
    arrival_shift_ += back;
    sample += back;
    arrival = arrival_;
  }
  const Duration earliest = kind == Kind::kJump ? delay_.offset() + span_ : sample;
  delay_.begin(sample, std::max(sample, earliest), arrival);
  arrival_ = kind == Kind::kJump ? std::max(arrival_, arrival) : arrival;
  started_ = true;
  stepped_ = false;
  set_aside_ = 0;
}

DeviceTime::Stamp DeviceTime::follow(Duration step, Time arrival) {
  device_ += step;
  delay_.advance(step, arrival, std::max(step - busy_, Duration{}));
  // A stamp far after its packet's firings is wrong, and must not make the next packets look as if they went back.
  arrival_ = std::max(arrival_, std::min(arrival, last_first_firing() + span_ + kMaxDelay));
  const double catch_up = delay_.catch_up();
  const double pace = catch_up > kEvenSlew ? 1.0 - catch_up : 1.0;
  // The lasers of the last firing keep the device's own pace.
  const double busy = to_seconds(busy_share(span_)) * pace + to_seconds(last_firing_share(span_)) * (1.0 - pace);
  busy_ = pace < 1.0 ? from_seconds(busy) : busy_share(span_);
  return {Kind::kNext, last_first_firing(), step, pace};
}

}  // namespace cairn::velodyne
