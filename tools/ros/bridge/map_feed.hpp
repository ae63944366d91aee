// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "drivers/clients/messages/hello.hpp"
#include "onboard/client/map_mirror.hpp"
#include "tools/ros/dds/topic.hpp"
#include "tools/ros/messages/map.hpp"

namespace cairn::ros {

/// One map of the core as a topic. It is written when it has changed and somebody reads it, not more often than once in
/// a period. Who comes later gets the last one.
class MapFeed {
 public:
  static Result<MapFeed> open(RosParticipant& participant, const std::string& topic, clients::TileMap map, MapForm form,
                              Duration period);

  void begin(const clients::HelloMessage& hello);
  /// Records of other maps are left alone. Error kMalformed.
  Result<void> take(const clients::TilesMessage& message);
  /// Writes the map if that is due. Error kLimit: it is too large.
  Result<void> tick(Time now, const Header& header, Arena& arena);

  /// Null before the first greeting.
  [[nodiscard]] const client::MapMirror* mirror() const { return mirror_ ? &*mirror_ : nullptr; }
  /// What the mirror has, for the next subscription.
  [[nodiscard]] clients::SubscribeMessage::Resume resume() const;
  [[nodiscard]] const Writer<Octomap>& writer() const { return writer_; }

 private:
  MapFeed(Writer<Octomap> writer, clients::TileMap map, MapForm form, Duration period)
      : writer_(writer), which_(map), form_(form), period_(period) {}

  Writer<Octomap> writer_;
  clients::TileMap which_;
  MapForm form_;
  Duration period_;
  std::optional<client::MapMirror> mirror_;
  double resolution_m_ = 0;
  bool changed_ = false;
  std::optional<Time> written_;
};

}  // namespace cairn::ros
