// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/clients/messages/camera.hpp"
#include "drivers/clients/messages/state.hpp"
#include "hal/clock.hpp"
#include "onboard/app/streams/client_hub.hpp"
#include "onboard/app/streams/event_feed.hpp"
#include "onboard/app/streams/outlets/stream_outlets.hpp"
#include "onboard/app/streams/picture_stream.hpp"
#include "onboard/app/streams/pose_predictor.hpp"
#include "onboard/app/streams/scan_stream.hpp"
#include "onboard/app/streams/thermal_stream.hpp"
#include "onboard/app/streams/tile_stream.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn::app {

/// A camera of which clients may have pictures.
struct ShownCamera {
  clients::CameraMessage message;
  Duration latency{};  ///< from the exposure to the stamp of the picture
};

/// Serves robot.sock, on a thread of its own. Nobody ever waits for it, and it waits for nobody.
class StreamsTask final : public scheduler::Task {
 public:
  /// `robot_id` in its team, or 0. `outlets` and `monitor` must outlive the task.
  StreamsTask(ClientHub hub, std::uint64_t session, std::uint64_t robot_id, StreamOutlets& outlets, Monitor& monitor);

  /// The cameras of which clients may have pictures: each at its number in the outlets. To be called before the run.
  void show(std::vector<ShownCamera> cameras) { cameras_ = std::move(cameras); }
  /// What makes thermal clouds; without it, `why_not` is what a client's wish for them leaves as an event. To be called
  /// before the run.
  void show(std::unique_ptr<ThermalStream> thermal, std::string why_not) {
    thermal_ = std::move(thermal);
    why_no_thermal_ = std::move(why_not);
  }
  /// Of a wheel, in metres; 0: not known. To be called before the run.
  void set_wheel_radius(double radius_m) { wheel_radius_m_ = radius_m; }

  void tick(scheduler::Tick& tick) override { serve(tick.release()); }

  /// After the run, in the place of ticks: `rest` hands the last tiles to the outlets, and says true when it has.
  /// Clients that read get all of them. A client that takes nothing in kAttempts is left behind. They are a millisecond
  /// apart, and more on a busy machine, where a client waits for its turn as well. After kAllAttempts nobody is waited
  /// for, or clients that come again and again could keep a robot from its end.
  void close(const Clock& clock, const std::function<bool()>& rest);
  static constexpr int kAttempts = 500, kAllAttempts = 30'000;

 private:
  std::size_t serve(Time now);
  void greet_subscribers(Time now);
  void greet(StreamClient& client, Time now);
  void send_poses();
  void send_people();
  void send_wheels();
  void send_pictures();
  void send_clouds();
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
  std::unique_ptr<ThermalStream> thermal_;
  std::string why_no_thermal_ = "there is no thermal camera";
  std::vector<ShownCamera> cameras_;
  std::array<PictureStream, kShownCameras> pictures_{PictureStream(0), PictureStream(1), PictureStream(2)};
  double wheel_radius_m_ = 0;
  TileStream own_, team_;
  clients::StateMessage state_;
  RateLimit state_beat_{1}, event_beat_;
};

}  // namespace cairn::app
