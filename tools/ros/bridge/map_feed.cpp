// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/bridge/map_feed.hpp"

namespace cairn::ros {

Result<MapFeed> MapFeed::open(RosParticipant& participant, const std::string& topic, clients::TileMap map, MapForm form,
                              Duration period) {
  const auto writer = Writer<Octomap>::open(participant, topic, TopicUse::kLatched);
  if (!writer) return writer.error();
  return MapFeed(*writer, map, form, period);
}

void MapFeed::begin(const clients::HelloMessage& hello) {
  if (mirror_ && resolution_m_ == hello.resolution_m) return;  // what is new comes with another session
  mirror_.emplace(which_, hello.resolution_m);
  resolution_m_ = hello.resolution_m;
}

Result<void> MapFeed::take(const clients::TilesMessage& message) {
  if (!mirror_) return {};
  const auto taken = mirror_->take(message);
  const auto changes = mirror_->take_changes();
  changed_ = changed_ || changes.anew || !changes.tiles.empty();
  return taken;
}

Result<void> MapFeed::tick(Time now, const Header& header, Arena& arena) {
  const bool early = written_ && now - *written_ < period_;
  if (!changed_ || early || !mirror_->caught_up() || !writer_.read_by_anybody()) return {};
  written_ = now;
  const auto message = octomap_of(mirror_->map(), form_, header, arena);
  changed_ = message && !writer_.write(*message);
  return message ? Result<void>{} : message.error();
}

clients::SubscribeMessage::Resume MapFeed::resume() const {
  return mirror_ ? mirror_->resume() : clients::SubscribeMessage::Resume{};
}

}  // namespace cairn::ros
