// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/clients/messages/command.hpp"
#include "drivers/peers/peer_port.hpp"
#include "hal/geo_fix.hpp"
#include "hal/latest_value.hpp"
#include "hal/monitor.hpp"
#include "onboard/app/live/live_view.hpp"
#include "onboard/app/profile/team_profile.hpp"
#include "onboard/app/streams/outlets/stream_outlets.hpp"
#include "onboard/app/streams/outlets/tile_outlet.hpp"
#include "onboard/app/team/satellite_place.hpp"
#include "onboard/app/team/team_messages.hpp"
#include "onboard/safety/overload.hpp"
#include "onboard/scheduler/feed.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// The robot's part in its team, several times a second: tiles and datagrams of peers in, datagrams out, and a slice of
/// work on the map of the team.
class TeamTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  scheduler::InputPort<TileBatch> tiles{*this, "tiles"};
  const std::size_t datagrams_slot = take_slots();  ///< datagrams taken
  const std::size_t fuse_slot = take_slots();       ///< tiles fused
  scheduler::OutputPort<team::MatchJob> jobs{*this, "jobs"};
  scheduler::InputPort<team::MatchJob> results{*this, "results"};
  scheduler::OutputPort<Mates> mates{*this, "mates"};
  const std::size_t shed_slot = take_slots();  ///< 1: peers' maps wait, because the robot is overloaded
  scheduler::InputPort<clients::Placement> places{*this, "places"};
  scheduler::InputPort<GeoFix> fixes{*this, "fixes"};

  /// `monitor` must outlive the task. `name` and `resolution_m` are those of the robot.
  TeamTask(const TeamProfile& profile, std::string name, double resolution_m, Monitor& monitor);
  /// Before the run. `shed`: what is left out now; any thread may ask it.
  void spare(std::function<safety::Shed()> shed) { shed_ = std::move(shed); }
  /// Before the run: the run goes on in the map of the previous run.
  void go_on() { epoch_ = 0; }
  /// Before the run. `source` must outlive the task. `port` is the same source, to send through; null in a replay.
  void attach(Source& source, SourceId id, peer_link::PeerPort* port, scheduler::Feed::Tap tap);
  /// Live: tiles of the team's map that have changed go to `outlet`, and where odom lies in it to `T_team_odom`. To be
  /// called before the run; both must outlive the task.
  void serve(TileOutlet& outlet, LatestValue<std::optional<SE3>>& T_team_odom) {
    outlet_ = &outlet;
    pose_outlet_ = &T_team_odom;
  }
  /// Live: what peers say of people goes to `outlet`, in this robot's odom. What finds no room is left out. To be
  /// called before the run; `outlet` must outlive the task.
  void tell_people(SpscQueue<PeopleNews>& outlet) { people_outlet_ = &outlet; }
  /// After the run: `outlet` gets what is left, as far as it has room. True: it has it all.
  bool serve_rest();

  void tick(scheduler::Tick& tick) override;

  /// None before the robot's beginning has come. Of the task's thread, or after the run.
  [[nodiscard]] const std::optional<team::Team>& team() const { return team_; }
  /// How long it took from hearing that a peer has new versions until all of them were here.
  [[nodiscard]] const std::map<peers::RobotId, Histogram>& lags() const { return lags_; }
  [[nodiscard]] std::uint64_t missing_packets() const { return feed_ ? feed_->missing() : 0; }
  [[nodiscard]] Time first_arrival() { return feed_ ? feed_->first_arrival() : Time::max(); }
  [[nodiscard]] const SatellitePlace& satellites() const { return satellites_; }
  [[nodiscard]] Time last_step() const { return last_step_; }
  /// For one other thread: a new value about once a second.
  [[nodiscard]] LatestValue<std::vector<LiveView::Peer>>& view() { return view_; }

 private:
  static constexpr std::uint32_t kFirstEpoch = 1;  // see Resume

  [[nodiscard]] bool overloaded(scheduler::Tick& tick) const;
  void hear(scheduler::Tick& tick);
  void take(const Packet& packet, Time now);
  void begin(const Packet& packet, Time now);
  void observe(scheduler::Tick& tick);
  [[nodiscard]] SE3 T_odom_base_at(Time now) const;
  void be_placed(scheduler::Tick& tick);
  void be_placed_by_satellites(const GeoFix& fix);
  void be_placed(const clients::Placement& place, Time now);
  void judge(bool lost, Time now);
  void learn(scheduler::Tick& tick);
  void speak(scheduler::Tick& tick);
  void hand_out_a_job(scheduler::Tick& tick);
  void fuse(scheduler::Tick& tick);
  void note_lags(Time now);
  void publish_peers(Time now);
  void hand_to_clients(std::size_t most);
  void pass_on_bodies(scheduler::Tick& tick);
  void tell_clients(const team::PeerBodies& peer, Time now);

  std::function<safety::Shed()> shed_;
  bool spared_ = false;  // in this tick, peers' maps wait
  TeamProfile profile_;
  std::string name_;
  double resolution_m_;
  Monitor& monitor_;
  StageStats& fusion_;
  std::optional<scheduler::Feed> feed_;
  peer_link::PeerPort* port_ = nullptr;
  std::optional<team::Team> team_;
  std::uint32_t epoch_ = kFirstEpoch;  // of the tiles
  std::vector<peers::Outgoing> out_;
  struct Seen {
    SE3 T_odom_base;
    Vector6 twist = Vector6::Zero();
    Time stamp{};
  };
  std::optional<Seen> last_seen_;  // where the robot was
  SatellitePlace satellites_;
  Time last_step_ = Time::min(), last_published_ = Time::min();
  struct Awaited {
    peers::Epoch epoch = 0;
    peers::Version newest = 0;
    Time since{};
  };
  std::map<peers::RobotId, Awaited> awaited_;
  std::map<peers::RobotId, Histogram> lags_;
  std::map<peers::RobotId, bool> merged_;
  LatestValue<std::vector<LiveView::Peer>> view_;
  TileOutlet* outlet_ = nullptr;
  LatestValue<std::optional<SE3>>* pose_outlet_ = nullptr;
  SpscQueue<PeopleNews>* people_outlet_ = nullptr;
  std::map<peers::RobotId, Time> people_told_;  // when what clients were told was so
};

}  // namespace cairn::app
