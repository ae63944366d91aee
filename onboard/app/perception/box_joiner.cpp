// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/box_joiner.hpp"

#include <string>

namespace cairn::app {

void BoxJoiner::add(people::Eye eye, Detections& boxes) {
  auto& waiting = waiting_[static_cast<std::size_t>(eye)];
  if (waiting.size() == kWaiting) {
    leave_out(waiting.front(), "no scan came after the picture for a long time: its boxes are left out");
    waiting.pop();
  }
  waiting.add(boxes);
}

void BoxJoiner::join(Time now) {
  join(people::Eye::kVisible, now);
  join(people::Eye::kThermal, now);
}

void BoxJoiner::join(people::Eye eye, Time now) {
  auto& waiting = waiting_[static_cast<std::size_t>(eye)];
  for (; !waiting.empty(); waiting.pop()) {
    const Time exposed = waiting.front().stamp;
    if (exposed > now + kAhead) {
      leave_out(waiting.front(), "the picture's time is in the future: its boxes are left out; check its clock");
      continue;
    }
    if (robot_.before_map(exposed)) {
      ++apart_;  // at every start
      continue;
    }
    const auto told = robot_.see_people(eye, waiting.front());
    if (told && !*told) return;  // the scan after the picture is still to come
    if (told) answers_.add(robot_.answered());
    if (!told) leave_out(waiting.front(), to_string(told.error()));
  }
}

void BoxJoiner::leave_out(const Detections& boxes, const std::string& why) {
  ++apart_;
  monitor_.event(boxes.stamp, "people", why);
}

}  // namespace cairn::app
