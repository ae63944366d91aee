// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/paced_source.hpp"

#include <poll.h>

#include <algorithm>
#include <cassert>
#include <ctime>
#include <utility>

namespace cairn::recording {

Waiter live_waiter() {
  return [](Duration span) {
    if (span <= Duration::zero()) return;
    const timespec wait{static_cast<std::time_t>(span.count() / 1'000'000'000),
                        static_cast<long>(span.count() % 1'000'000'000)};
    // An interrupted wait is a shorter one; the caller looks at its clock anyway.
    static_cast<void>(::ppoll(nullptr, 0, &wait, nullptr));
  };
}

PacedSource::PacedSource(Source& recorded, const Clock& clock, Waiter wait, double rate)
    : recorded_(recorded), clock_(clock), wait_(std::move(wait)), rate_(rate) {
  assert(rate > 0);
}

Time PacedSource::due() const {
  return start_->clock + from_seconds(to_seconds(pending_.arrival - start_->arrival) / rate_);
}

Result<Poll> PacedSource::next(Packet& packet, Duration timeout) {
  if (!has_pending_) {
    const auto poll = recorded_.next(pending_, timeout);
    if (!poll || *poll != Poll::kPacket) return poll;
    has_pending_ = true;
    if (!start_) start_ = Start{clock_.now(), pending_.arrival};
  }
  if (const Duration early = due() - clock_.now(); early > Duration::zero()) {
    wait_(std::min(early, timeout));
    if (clock_.now() < due()) return Poll::kTimeout;
  }
  std::swap(packet, pending_);
  has_pending_ = false;
  return Poll::kPacket;
}

}  // namespace cairn::recording
