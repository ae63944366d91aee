// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/streams_task.hpp"

#include <utility>

#include "drivers/clients/messages/state.hpp"
#include "onboard/app/streams/messages/people_message.hpp"
#include "onboard/app/streams/messages/state_message.hpp"
#include "onboard/app/streams/messages/wheels_message.hpp"

namespace cairn::app {
namespace {

using clients::Stream;
using clients::TileMap;

// In one tick. Encoding a tile takes a microsecond, making and sending a full record some tens.
constexpr std::size_t kTiles = 512, kTileRecords = 8, kCloudRecords = 16, kPictureRecords = 16;
constexpr double kEvents_hz = 10;
constexpr Duration kClosingStep = std::chrono::milliseconds(1);

}  // namespace

StreamsTask::StreamsTask(ClientHub hub, std::uint64_t session, std::uint64_t robot_id, StreamOutlets& outlets,
                         Monitor& monitor)
    : hub_(std::move(hub)),
      outlets_(outlets),
      monitor_(monitor),
      events_(monitor),
      own_(TileMap::kOwn, session, robot_id),
      team_(TileMap::kTeam, session, 0),
      event_beat_(kEvents_hz) {}

/// Poses first: they are what is wanted at once. Returns how many records of tiles were sent.
std::size_t StreamsTask::serve(Time now) {
  send_poses();
  send_people();
  send_wheels();
  hub_.receive(now);
  greet_subscribers(now);
  send_predictions(now);
  send_state(now);
  send_events(now);
  send_clouds();
  send_pictures();
  return send_tiles(now);
}

void StreamsTask::greet(StreamClient& client, Time now) {
  own_.begin(client);
  team_.begin(client);
  if (client.wants.wants(Stream::kState)) hub_.send(client, state_);
  if (client.wants.wants(Stream::kEvents))
    for (const clients::EventMessage& event : events_.so_far()) hub_.send(client, event);
  if (client.wants.wants(Stream::kCameras))
    for (const ShownCamera& camera : cameras_) hub_.send(client, camera.message);
  if (client.wants.wants(Stream::kThermal) && thermal_ == nullptr)
    monitor_.event(now, "clients", "a client gets no thermal clouds of this robot: " + why_no_thermal_);
}

void StreamsTask::greet_subscribers(Time now) {
  for (StreamClient& client : hub_.clients())
    if (std::exchange(client.fresh, false)) greet(client, now);
  const bool thermal = thermal_ != nullptr && hub_.anybody_wants(Stream::kThermal);
  outlets_.scans_wanted.store(thermal || hub_.anybody_wants(Stream::kScan), std::memory_order_relaxed);
  outlets_.thermal.wanted.store(thermal, std::memory_order_relaxed);
  outlets_.wheels_wanted.store(hub_.anybody_wants(Stream::kWheels), std::memory_order_relaxed);
  const bool pictures = hub_.anybody_wants(Stream::kPictures);
  for (PictureOutlet& outlet : outlets_.pictures) outlet.wanted.store(pictures, std::memory_order_relaxed);
}

void StreamsTask::send_poses() {
  for (; const PoseNews* news = outlets_.poses.front(); outlets_.poses.pop()) {
    predictor_.take(*news);
    state_.map_epoch = news->point.epoch;
    hub_.send_all(Stream::kPose, message_of(news->point));
  }
}

void StreamsTask::send_people() {
  for (; const PeopleNews* news = outlets_.people.front(); outlets_.people.pop())
    hub_.send_all(Stream::kPeople, message_of(*news));
  for (; const PeopleNews* news = outlets_.team_people.front(); outlets_.team_people.pop())
    hub_.send_all(Stream::kTeamPeople, message_of(*news));
}

void StreamsTask::send_wheels() {
  for (; const WheelNews* news = outlets_.wheels.front(); outlets_.wheels.pop())
    hub_.send_all(Stream::kWheels, message_of(*news, wheel_radius_m_));
}

void StreamsTask::send_pictures() {
  std::size_t records = kPictureRecords;
  for (const ShownCamera& camera : cameras_) {
    const std::size_t i = camera.message.camera;
    pictures_[i].serve(hub_, outlets_.pictures[i].pictures, camera.latency, records);
  }
}

/// Scans are shown to the thermal camera before they are sent, and its clouds follow.
void StreamsTask::send_clouds() {
  const bool thermal = outlets_.thermal.wanted.load(std::memory_order_relaxed);
  scans_.serve(hub_, outlets_.scans, kCloudRecords, [&](const LocatedScan& scan) {
    if (thermal) thermal_->add(scan);
  });
  if (thermal_ == nullptr) return;
  for (; const Packet* picture = outlets_.thermal.pictures.front(); outlets_.thermal.pictures.pop())
    if (thermal) thermal_->add(*picture);
  thermal_->serve(hub_, kCloudRecords);
}

void StreamsTask::send_predictions(Time now) {
  std::optional<clients::PoseMessage> pose;
  for (StreamClient& client : hub_.clients()) {
    if (!client.wants.wants(Stream::kPose) || client.wants.pose_hz == 0 || !client.predictions.due(now)) continue;
    if (!pose) pose = predictor_.at(now);
    if (!pose) return;
    hub_.send(client, *pose);
  }
}

void StreamsTask::send_state(Time now) {
  const bool changed = outlets_.state.refresh() && update(outlets_.state.value(), state_);
  if (!state_beat_.due(now) && !changed) return;
  state_.stamp = now;
  hub_.send_all(Stream::kState, state_);
}

void StreamsTask::send_events(Time now) {
  if (!event_beat_.due(now)) return;
  for (const clients::EventMessage& event : events_.news()) hub_.send_all(Stream::kEvents, event);
}

std::size_t StreamsTask::send_tiles(Time now) {
  const bool own_fits = own_.take(outlets_.own, kTiles), team_fits = team_.take(outlets_.team, kTiles);
  if (!own_fits || !team_fits)
    monitor_.event(now, "clients", "the map is too large for the clients' memory: new tiles are left out");
  const std::size_t sent = own_.serve(hub_, now, kTileRecords);
  return sent + team_.serve(hub_, now, kTileRecords - sent);
}

bool StreamsTask::all_served() {
  return outlets_.own.settled() && outlets_.team.settled() && own_.all_caught_up(hub_) && team_.all_caught_up(hub_);
}

void StreamsTask::close(const Clock& clock, const std::function<bool()>& rest) {
  for (int idle = 0, all = 0; idle < kAttempts && all < kAllAttempts; ++idle, ++all) {
    const Time now = clock.now();
    const bool handed_over = rest();
    // A client's pause may be longer than all attempts.
    own_.try_again(hub_);
    team_.try_again(hub_);
    const std::size_t waiting = outlets_.own.tiles().size() + outlets_.team.tiles().size();
    if (serve(now) + waiting > 0) idle = 0;
    if (handed_over && all_served()) return;
    LiveClock::wait_until(clock.now() + kClosingStep);
  }
}

}  // namespace cairn::app
