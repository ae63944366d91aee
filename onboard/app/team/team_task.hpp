// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "drivers/peers/peer_port.hpp"
#include "hal/latest_value.hpp"
#include "hal/monitor.hpp"
#include "onboard/app/live/live_view.hpp"
#include "onboard/app/profile/team_profile.hpp"
#include "onboard/app/team/team_messages.hpp"
#include "onboard/scheduler/feed.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn {

/// The robot's part in its team, several times a second: tiles and peers' datagrams in, datagrams out, and a slice of
/// work on the team's map. Slots: 0 batches of tiles and 1 datagrams taken, 2 tiles fused, 3 jobs accepted, 4 results
/// taken.
class TeamTask final : public scheduler::Task {
 public:
  static constexpr std::size_t kTilesSlot = 0, kFeedSlot = 1, kFuseSlot = 2, kJobsSlot = 3, kResultsSlot = 4;

  struct Parts {
    TileChannel& tiles;
    MatchChannel& jobs;
    MatchChannel& results;
  };
  /// All must outlive the task. `name` and `resolution_m` are the robot's.
  TeamTask(const TeamProfile& profile, std::string name, double resolution_m, const Parts& parts, Monitor& monitor);
  /// Before the run: it goes on in the map of the one before it.
  void go_on() { epoch_ = 0; }
  /// Before the run. `port`: live, the same source, to be spoken to; or null.
  void attach(Source& source, SourceId id, peers::PeerPort* port, scheduler::Feed::Tap tap);

  void tick(scheduler::Tick& tick) override;

  /// None before the beginning has come. Of the task's thread, or of a run that has ended.
  [[nodiscard]] const std::optional<Team>& team() const { return team_; }
  /// From hearing that a peer has said more to knowing all of it.
  [[nodiscard]] const std::map<peers::RobotId, Histogram>& lags() const { return lags_; }
  [[nodiscard]] std::uint64_t missing_packets() const { return feed_ ? feed_->missing() : 0; }
  [[nodiscard]] Time first_arrival() { return feed_ ? feed_->first_arrival() : Time::max(); }
  [[nodiscard]] Time last_step() const { return last_step_; }
  /// Another thread, one of them: news about once a second.
  [[nodiscard]] LatestValue<std::vector<LiveView::Peer>>& view() { return view_; }

 private:
  static constexpr std::uint32_t kFirstEpoch = 1;  // see Resume

  void hear(scheduler::Tick& tick);
  void take(const Packet& packet, Time now);
  void begin(const Packet& packet, Time now);
  void observe(scheduler::Tick& tick);
  void learn(scheduler::Tick& tick);
  void speak(scheduler::Tick& tick);
  void hand_out_a_job(scheduler::Tick& tick);
  void fuse(scheduler::Tick& tick);
  void note_lags(Time now);
  void tell(Time now);

  TeamProfile profile_;
  std::string name_;
  double resolution_m_;
  Parts parts_;
  Monitor& monitor_;
  StageStats& fusion_;
  std::optional<scheduler::Feed> feed_;
  peers::PeerPort* port_ = nullptr;
  std::optional<Team> team_;
  std::uint32_t epoch_ = kFirstEpoch;  // of the tiles
  std::vector<peers::Outgoing> out_;
  Time last_step_ = Time::min(), last_told_ = Time::min();
  struct Awaited {
    peers::Epoch epoch = 0;
    peers::Version newest = 0;
    Time since{};
  };
  std::map<peers::RobotId, Awaited> awaited_;
  std::map<peers::RobotId, Histogram> lags_;
  std::map<peers::RobotId, bool> merged_;
  LatestValue<std::vector<LiveView::Peer>> view_;
};

/// Compares maps, one pair at a time, for as long as that takes: at the lowest priority and in nobody's way. Slots: 0
/// jobs taken, 1 steps granted, 2 results accepted.
class MatchTask final : public scheduler::Task {
 public:
  static constexpr std::size_t kJobsSlot = 0, kStepsSlot = 1, kResultsSlot = 2;
  /// All must outlive the task.
  MatchTask(Duration limit, MatchChannel& jobs, MatchChannel& results, Monitor& monitor)
      : limit_(limit), jobs_(jobs), results_(results), stage_(monitor.stage("matching")) {}
  void tick(scheduler::Tick& tick) override;

 private:
  Duration limit_;
  MatchChannel& jobs_;
  MatchChannel& results_;
  StageStats& stage_;
};

}  // namespace cairn
