// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/feed.hpp"

#include <utility>

namespace cairn::scheduler {
namespace {

// Errors in a row. After them, the source is asked again in the next tick.
constexpr int kMaxComplaints = 1000;

}  // namespace

/// Fills next_ with what the source has now.
bool Feed::read(Time now, int limit) {
  for (int tries = 0; !ahead_ && !ended_ && tries < limit; ++tries) {
    const auto polled = source_.next(next_, Duration{0});
    if (!polled)
      complain_(now, polled.error());
    else if (*polled == Poll::kEnd)
      ended_ = true;
    else if (*polled == Poll::kPacket)
      ahead_ = true;
    else if (limit == 1)
      break;
  }
  return ahead_;
}

Time Feed::first_arrival() { return read(Time{}, kMaxComplaints) ? next_.arrival : Time::max(); }

const Packet* Feed::take_ahead() {
  std::swap(packet_, next_);
  packet_.source = id_;
  ahead_ = false;
  ++taken_;
  if (tap_) tap_(packet_);
  return &packet_;
}

const Packet* Feed::take(Tick& tick) {
  if (tick.index() != taking_) {
    taking_ = tick.index();
    taken_ = 0;
  }
  std::int32_t& logged = tick.slot(slot_);
  switch (tick.regime()) {
    case Regime::kLive:
      if (taken_ >= kMaxPackets || !read(tick.release(), 1)) return nullptr;
      logged = taken_ + 1;
      return take_ahead();
    case Regime::kLogged:
      if (taken_ >= logged) return nullptr;
      if (read(tick.release(), kMaxComplaints)) return take_ahead();
      missing_ += static_cast<std::uint64_t>(logged - taken_);
      taken_ = logged;
      return nullptr;
    case Regime::kVirtual:
      return read(tick.release(), kMaxComplaints) && next_.arrival <= tick.release() ? take_ahead() : nullptr;
    case Regime::kDrain:
      return nullptr;  // what arrived after the last tick came too late
  }
  return nullptr;
}

}  // namespace cairn::scheduler
