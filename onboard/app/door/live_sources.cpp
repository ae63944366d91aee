// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/door/live_sources.hpp"

#include <algorithm>

namespace cairn::app {

Result<Poll> LiveSources::look(Packet& packet, Duration timeout) {
  for (std::size_t tried = 0; tried < sources_.size();) {
    turn_ = turn_ % sources_.size();
    auto poll = sources_[turn_]->next(packet, timeout);
    if (poll && *poll == Poll::kEnd) {
      sources_.erase(sources_.begin() + static_cast<std::ptrdiff_t>(turn_));
      continue;
    }
    ++turn_;
    ++tried;
    if (!poll || *poll == Poll::kPacket) return poll;
  }
  return sources_.empty() ? Poll::kEnd : Poll::kTimeout;
}

Result<Poll> LiveSources::next(Packet& packet, Duration timeout) {
  const Time deadline = clock_.now() + timeout;
  auto poll = look(packet, Duration{0});
  while (poll && *poll == Poll::kTimeout) {
    const Duration left = deadline - clock_.now();
    if (left <= Duration{0}) return Poll::kTimeout;
    poll = look(packet, std::min(left, kGlance) / static_cast<std::int64_t>(sources_.size()));
  }
  return poll;
}

}  // namespace cairn::app
