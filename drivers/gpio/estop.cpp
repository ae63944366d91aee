// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/estop.hpp"

#include <array>

namespace cairn::gpio {

std::string_view to_string(EStop::Cause cause) {
  constexpr std::array<std::string_view, 5> kNames{"never armed", "the contact opened", "edges were lost",
                                                   "the level was not read in time", "the line is lost"};
  const auto i = static_cast<std::size_t>(cause);
  return i < kNames.size() ? kNames[i] : "unknown";
}

EStop::EStop(const Config& config)
    : release_(from_seconds(config.estop_release_ms / 1000)), rearm_(from_seconds(config.estop_rearm_ms / 1000)) {}

void EStop::stop(Cause cause) {
  if (!latched_) cause_ = cause;
  latched_ = true;
}

void EStop::open() {
  if (closed_) ++counters_.opened;
  closed_ = false;
  closed_since_.reset();
  stop(Cause::kOpened);
}

void EStop::edge(Time stamp, bool closed, std::uint32_t sequence) {
  ++counters_.edges;
  if (sequence != 0 && sequence_ != 0 && sequence != sequence_ + 1) {
    counters_.edges_lost += sequence - sequence_ - 1;
    stop(Cause::kEdgesLost);
    closed_since_.reset();
  }
  if (sequence != 0) sequence_ = sequence;
  if (!closed) return open();
  // Every closing edge starts the wait anew, also one without the opening between: the contact bounces.
  closed_ = true;
  if (!closed_since_ || stamp > *closed_since_) closed_since_ = stamp;
}

void EStop::level(Time now, bool closed) {
  read_at_ = now;
  if (closed != closed_) ++counters_.unseen_edges;
  if (!closed) return open();
  closed_ = true;
  if (!closed_since_) closed_since_ = now;
}

void EStop::lost(Time) {
  closed_ = false;
  closed_since_.reset();
  stop(Cause::kLineLost);
}

bool EStop::released(Time now) const { return closed_ && closed_since_ && now - *closed_since_ >= release_; }

bool EStop::stopped(Time now) {
  if (!read_at_ || now - *read_at_ > kSilence) {
    stop(Cause::kSilent);
    closed_since_.reset();
  }
  return latched_;
}

Result<void> EStop::rearm(Time now) {
  const auto refuse = [](std::string_view cause) { return Error{Errc::kLinkDown, cause, {}, {}, {}}; };
  if (!read_at_ || now - *read_at_ > kSilence)
    return refuse("cannot leave the emergency stop: the level was not read in time");
  if (!released(now))
    return refuse("cannot leave the emergency stop: the contact is open: release the button, check the wire");
  if (now - *closed_since_ < rearm_)
    return refuse("cannot leave the emergency stop: the contact has not been closed for long enough");
  latched_ = false;
  return {};
}

}  // namespace cairn::gpio
