// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/team_task.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "drivers/peers/peer_packet.hpp"
#include "onboard/app/team/placing.hpp"
#include "onboard/app/team/team_people.hpp"

namespace cairn::app {

using scheduler::Regime;
using scheduler::Tick;

namespace {

constexpr Duration kStepPeriod = std::chrono::milliseconds(100), kPublishPeriod = std::chrono::seconds(1);
// A tile takes some tens of microseconds, memory for more nodes a few more: 2 ms, less what the last step takes too
// long.
constexpr Duration kFusionSlice = std::chrono::microseconds(1500);
constexpr int kSliceTiles = 100;
// Tiles come twice a second: until then the robot goes on as it did.
constexpr double kLongestGuess_s = 1;
// For clients. A tile takes as long as it takes to fuse it.
constexpr std::size_t kTeamTilesInATick = 32;

}  // namespace

TeamTask::TeamTask(const TeamProfile& profile, std::string name, double resolution_m, Monitor& monitor)
    : profile_(profile),
      name_(std::move(name)),
      resolution_m_(resolution_m),
      monitor_(monitor),
      fusion_(monitor.stage("fusion")),
      satellites_(profile.satellites) {}

void TeamTask::attach(Source& source, SourceId id, peer_link::PeerPort* port, scheduler::Feed::Tap tap) {
  const auto complain = [this](Time now, const Error& error) { monitor_.event(now, "team", to_string(error)); };
  feed_.emplace(source, id, datagrams_slot, complain, std::move(tap));
  port_ = port;
}

void TeamTask::tick(Tick& tick) {
  spared_ = overloaded(tick);
  if (tick.regime() != Regime::kDrain) {
    hear(tick);
    observe(tick);
    be_placed(tick);
    learn(tick);
    speak(tick);
  }
  fuse(tick);
  if (outlet_ == nullptr || !team_) return;
  hand_to_clients(kTeamTilesInATick);
  const auto& poses = team_->poses().T_team_odom;
  const auto own = poses.find(team_->exchange().self());
  pose_outlet_->publish(own != poses.end() ? std::optional(own->second) : std::nullopt);
}

/// Virtual time knows no overload.
bool TeamTask::overloaded(Tick& tick) const {
  const auto ask = [this] { return shed_ && shed_() >= safety::Shed::kPeerTiles ? 1 : 0; };
  return tick.decide(shed_slot, ask, 0) != 0;
}

/// A tile's contributors are looked up in each submap, as when it is fused.
void TeamTask::hand_to_clients(std::size_t most) {
  outlet_->begin(0);  // the team's map goes on, whatever happens to the robots' own
  outlet_->owe(team_->take_changed_tiles());
  outlet_->hand_over(most, [this](TileNews& news) {
    auto origin = team_->map().origin_of(news.tile);
    news.state = mapping::read_tile(team_->map().map(), news.tile);
    news.changed = origin.newest;
    news.contributors = std::move(origin.robots);
  });
}

bool TeamTask::serve_rest() {
  if (!team_) return true;
  hand_to_clients(std::numeric_limits<std::size_t>::max());
  return outlet_->owed() == 0;
}

void TeamTask::hear(Tick& tick) {
  while (const Packet* packet = feed_->take(tick)) take(*packet, tick.release());
  if (feed_->ended()) tick.end_of_input();
}

void TeamTask::take(const Packet& packet, Time now) {
  if (packet.channel == static_cast<std::uint16_t>(peer_link::PacketKind::kBeginning)) return begin(packet, now);
  if (!team_) return;
  // The cause alone: offsets, of which there are as many as a liar likes, would crowd out all other events.
  if (const auto taken = team_->receive(packet.payload(), now); !taken)
    monitor_.event(now, "team", taken.error().cause);
}

void TeamTask::begin(const Packet& packet, Time now) {
  const auto beginning = peer_link::decode_beginning(packet.payload());
  if (!beginning || team_) return monitor_.event(now, "team", "an invalid beginning was ignored");
  team_.emplace(team_config(profile_, beginning->robot, name_, resolution_m_), beginning->epoch);
  if (outlet_ != nullptr) team_->note_map_changes();
}

void TeamTask::observe(Tick& tick) {
  while (const TileBatch* batch = tiles.take(tick)) {
    if (!team_) continue;
    if (std::exchange(epoch_, batch->epoch) != batch->epoch) {
      team_->begin(after(team_->exchange().epoch()));
      satellites_.begin();
    }
    team_->be_at(batch->T_odom_base);
    last_seen_ = {batch->T_odom_base.mean, batch->twist, batch->stamp};
    team_->show(bodies_of(*batch, profile_), batch->stamp);
    for (const auto& [tile, state] : batch->tiles) team_->observe(tile, state, tick.release());
    judge(batch->lost, tick.release());
  }
}

/// Where the robot was when tiles came last, and its motion since.
SE3 TeamTask::T_odom_base_at(Time now) const {
  const double moving_s = std::clamp(to_seconds(now - last_seen_->stamp), 0.0, kLongestGuess_s);
  return last_seen_->T_odom_base * SE3::exp(last_seen_->twist * moving_s);
}

void TeamTask::be_placed(Tick& tick) {
  while (const GeoFix* fix = fixes.take(tick))
    if (team_ && last_seen_) be_placed_by_satellites(*fix);
  while (const clients::Placement* place = places.take(tick)) be_placed(*place, tick.release());
}

void TeamTask::be_placed_by_satellites(const GeoFix& fix) {
  const bool known = satellites_.figures().T_site_odom && team::knows_yaw(*satellites_.figures().T_site_odom);
  const auto T_site_odom = satellites_.take(fix, T_odom_base_at(fix.stamp));
  if (satellites_.figures().too_far > 0)
    monitor_.event(fix.stamp, "team", "satellites put it more than 100 km from the origin of team.satellites");
  if (!T_site_odom) return;
  const bool knows = team::knows_yaw(*T_site_odom);
  team_->deploy(*T_site_odom, knows);
  if (knows && !known) monitor_.event(fix.stamp, "team", "satellites tell where it is, and its heading");
}

void TeamTask::be_placed(const clients::Placement& place, Time now) {
  if (!team_ || !last_seen_) return monitor_.event(now, "team", "it was placed before it had a pose: place it again");
  if (place.takes_back()) {
    team_->forget_place();
    return monitor_.event(now, "team", to_string(place));
  }
  const auto robot = robot_of_frame(place, *team_);
  const auto put = robot ? team_->put(T_frame_odom(place, T_odom_base_at(now)), *robot) : robot.error();
  monitor_.event(now, "team", put ? to_string(place) : "it cannot be placed: " + to_string(put.error()));
}

void TeamTask::judge(bool lost, Time now) {
  const peers::Doubt before = team_->doubt();
  team_->judge(lost, now);
  if (team_->doubt() == before) return;
  if (team_->doubt() == peers::Doubt::kLost)
    monitor_.event(now, "team", "what is mapped is held back from the team: odometry was lost");
  else if (team_->doubt() == peers::Doubt::kContradicted)
    monitor_.event(now, "team", "what is mapped is held back from the team: scans contradict the map");
  else
    monitor_.event(now, "team", "what is mapped is shared with the team again");
}

void TeamTask::learn(Tick& tick) {
  while (team::MatchJob* job = results.take(tick)) team_->matched(std::move(*job), tick.release());
}

void TeamTask::speak(Tick& tick) {
  const Time now = tick.release();
  if (!team_ || (last_step_ != Time::min() && now < last_step_ + kStepPeriod)) return;
  last_step_ = now;
  out_.clear();
  team_->step(now, out_);
  if (port_ != nullptr)
    for (const peers::Outgoing& datagram : out_) port_->send(datagram.to, datagram.bytes);
  if (!spared_) hand_out_a_job(tick);
  pass_on_bodies(tick);
  note_lags(now);
  if (last_published_ == Time::min() || now >= last_published_ + kPublishPeriod) publish_peers(now);
}

/// Where teammates and their people are. Mapping is told with every step, because it predicts no farther than that.
void TeamTask::pass_on_bodies(Tick& tick) {
  const Time now = tick.release();
  const auto peers = team_->peer_bodies(now);
  if (people_outlet_ != nullptr)
    for (const team::PeerBodies& peer : peers) tell_clients(peer, now);
  Mates* out = peers.empty() ? nullptr : mates.back(tick);
  if (out == nullptr) return;
  out->epoch = epoch_;
  out->mates.clear();
  for (const team::PeerBodies& peer : peers)
    out->mates.push_back({.stamp = now,
                          .position = peer.body.position_m,
                          .velocity = peer.body.velocity_m_s,
                          .radius_m = peer.body.radius_m,
                          .height_m = peer.body.height_m});
  mates.push(tick);
}

void TeamTask::tell_clients(const team::PeerBodies& peer, Time now) {
  const Time seen = now - peer.age;
  if (std::exchange(people_told_[peer.robot], seen) == seen) return;
  PeopleNews* out = people_outlet_->back();
  if (out == nullptr) return;
  *out = news_of(peer, epoch_, now);
  people_outlet_->push();
}

void TeamTask::hand_out_a_job(Tick& tick) {
  auto job = team_->next_match(tick.release());
  if (!job) return;
  if (team::MatchJob* place = jobs.back(tick)) {
    *place = std::move(*job);
    jobs.push(tick);
  } else {
    team_->matched(std::move(*job), tick.release());  // later
  }
}

/// At the end of a run, what is left is done, however much it is.
void TeamTask::fuse(Tick& tick) {
  if (!team_) return;
  if (tick.regime() == Regime::kDrain) {
    Budget all = Budget::steps(std::numeric_limits<int>::max());
    while (!team_->fuse(all)) continue;
    return;
  }
  if (spared_ || team_->map().up_to_date()) return;
  const StageTimer timing(fusion_);
  Budget budget = tick.budget(fuse_slot, tick.figure_now() + kFusionSlice, kSliceTiles);
  (void)team_->fuse(budget);
  tick.settle(fuse_slot, budget);
}

void TeamTask::note_lags(Time now) {
  const auto& layers = team_->exchange().layers();
  for (const auto& [robot, link] : team_->exchange().links()) {
    const auto layer = layers.find(robot);
    if (layer == layers.end()) continue;
    Awaited& awaited = awaited_[robot];
    const auto known = [&](peers::Version newest) { return layer->second.holding.known().complete(newest); };
    const bool same = awaited.epoch == link.epoch && layer->second.epoch == link.epoch;
    if (same && awaited.newest > 0 && known(awaited.newest)) {
      lags_[robot].record(now - awaited.since);
      awaited.newest = 0;
    }
    if (same && awaited.newest > 0) continue;
    const bool more = layer->second.epoch != link.epoch || !known(link.newest);
    awaited = {link.epoch, more ? link.newest : 0, now};
  }
}

void TeamTask::publish_peers(Time now) {
  last_published_ = now;
  auto& peers = view_.back();
  peers.clear();
  for (const auto& [robot, link] : team_->exchange().links()) {
    const team::PeerStanding standing = team_->standing(robot, now);
    const auto layer = team_->exchange().layers().find(robot);
    const bool known = layer != team_->exchange().layers().end();
    const std::string name = link.name.empty() ? "robot " + std::to_string(robot) : link.name;
    const auto clock = link.clock.estimate();
    peers.push_back({.name = name,
                     .merged = standing.merged(),
                     .state = std::string(to_string(standing.state)),
                     .reason = standing.reason,
                     .heard_s_ago = link.last_heard != Time::min() ? to_seconds(now - link.last_heard) : -1,
                     .tiles = known ? layer->second.holding.items().size() : 0,
                     .tx_bytes = link.sent_bytes,
                     .rx_bytes = link.received_bytes,
                     .clock_offset_s = clock ? to_seconds(clock->offset) : 0,
                     .deployment_contradicted = standing.deployment_contradicted});
    bool& merged = merged_[robot];
    if (standing.merged() != std::exchange(merged, standing.merged()))
      monitor_.event(now, "team", (merged ? "merged with " : "no longer merged with ") + name);
  }
  view_.publish();
}

}  // namespace cairn::app
