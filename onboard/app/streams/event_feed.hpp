// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/clients/messages/event.hpp"
#include "hal/monitor.hpp"

namespace cairn::app {

/// The events of a monitor as messages: each kind again when it has happened again.
class EventFeed {
 public:
  /// `monitor` must outlive the feed.
  explicit EventFeed(const Monitor& monitor) : monitor_(monitor) {}

  /// What has happened since the last call. Costs nothing where nothing has.
  [[nodiscard]] std::vector<clients::EventMessage> news();
  /// All that had happened by the last call of news().
  [[nodiscard]] std::vector<clients::EventMessage> so_far() const;

 private:
  const Monitor& monitor_;
  std::uint64_t kept_ = 0;
  std::vector<Event> events_;
};

}  // namespace cairn::app
