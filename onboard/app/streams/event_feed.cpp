// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/event_feed.hpp"

#include <utility>

namespace cairn::app {
namespace {

clients::EventMessage event_message(const Event& event) {
  return {.stamp = event.last, .count = event.count, .stage = event.stage, .what = event.what};
}

}  // namespace

/// The monitor only appends kinds, so each keeps its place.
std::vector<clients::EventMessage> EventFeed::news() {
  std::vector<clients::EventMessage> messages;
  const std::uint64_t kept = monitor_.kept_events();
  if (kept == kept_) return messages;
  kept_ = kept;
  const std::vector<Event> before = std::exchange(events_, monitor_.events_now());
  for (std::size_t i = 0; i < events_.size(); ++i)
    if (i >= before.size() || before[i].count != events_[i].count) messages.push_back(event_message(events_[i]));
  return messages;
}

std::vector<clients::EventMessage> EventFeed::so_far() const {
  std::vector<clients::EventMessage> messages;
  for (const Event& event : events_) messages.push_back(event_message(event));
  return messages;
}

}  // namespace cairn::app
