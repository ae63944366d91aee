// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/link_table.hpp"

namespace cairn::peers {

Link* LinkTable::open(RobotId peer) {
  const auto link = links_.find(peer);
  if (link != links_.end()) return &link->second;
  return links_.size() < max_robots_ ? &links_[peer] : nullptr;
}

bool LinkTable::hears(RobotId peer, Time now) const {
  const auto link = links_.find(peer);
  return link != links_.end() && link->second.last_heard + lease_ >= now;
}

void LinkTable::owe(RobotId robot) {
  for (auto& [peer, link] : links_) link.owed.insert(robot);
}

void LinkTable::forget_in_flight(RobotId robot) {
  for (auto& [peer, link] : links_)
    std::erase_if(link.in_flight, [&](const auto& sent) { return sent.first.first == robot; });
}

}  // namespace cairn::peers
