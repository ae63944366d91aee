// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "drivers/clients/messages/state.hpp"
#include "hal/clock.hpp"
#include "onboard/app/streams/client_hub.hpp"
#include "onboard/app/streams/event_feed.hpp"
#include "onboard/app/streams/pose_predictor.hpp"
#include "onboard/app/streams/scan_stream.hpp"
#include "onboard/app/streams/stream_outlets.hpp"
#include "onboard/app/streams/tile_stream.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn::app {

/// Serves robot.sock, on a thread of its own. Nobody ever waits for it, and it waits for nobody.
class StreamsTask final : public scheduler::Task {
 public:
  /// `robot_id` in its team, or 0. `outlets` and `monitor` must outlive the task.
  StreamsTask(ClientHub hub, std::uint64_t session, std::uint64_t robot_id, StreamOutlets& outlets, Monitor& monitor);

  void tick(scheduler::Tick& tick) override { serve(tick.release()); }

  /// After the run, in the place of ticks: `rest` hands the last tiles to the outlets, and says true when it has.
  /// Clients that read get all of them; who has not read for kPatience is left behind.
  void close(const Clock& clock, const std::function<bool()>& rest);
  static constexpr Duration kPatience = std::chrono::milliseconds(200);

 private:
  std::size_t serve(Time now);
  void greet_subscribers();
  void send_poses();
  void send_people();
  void send_predictions(Time now);
  void send_state(Time now);
  void send_events(Time now);
  std::size_t send_tiles(Time now);
  [[nodiscard]] bool all_served();

  ClientHub hub_;
  StreamOutlets& outlets_;
  Monitor& monitor_;
  EventFeed events_;
  PosePredictor predictor_;
  ScanStream scans_;
  TileStream own_, team_;
  clients::StateMessage state_;
  RateLimit state_beat_{1}, event_beat_;
};

}  // namespace cairn::app
