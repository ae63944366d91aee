// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/tile_stream.hpp"

#include <algorithm>
#include <utility>

#include "fusion/peers/items/tile_codec.hpp"

namespace cairn::app {
namespace {

using clients::TilesMessage;
static_assert(peers::kMaxTileBytes <= TilesMessage::kMaxTileBytes);

// From one attempt to the next while a client does not read: making a record costs some tens of microseconds.
constexpr Duration kFirstPause = std::chrono::microseconds(2500), kLongestPause = std::chrono::milliseconds(640);

TilesMessage::Tile encoded(const TileNews& news, std::uint64_t self) {
  TilesMessage::Tile tile{.key = news.tile.morton, .changed = news.changed, .contributors = news.contributors};
  if (self != 0) tile.contributors = {self};
  if (tile.contributors.size() > TilesMessage::kMaxContributors)
    tile.contributors.resize(TilesMessage::kMaxContributors);
  if (!news.state.empty()) peers::encode_tile(news.state, tile.bytes);
  tile.bytes.shrink_to_fit();
  return tile;
}

}  // namespace

bool TileStream::take(TileOutlet& outlet, std::size_t most) {
  bool room = true;
  for (std::size_t i = 0; i < most; ++i) {
    const TileNews* news = outlet.tiles().front();
    if (news == nullptr) break;
    store_.begin(news->epoch);
    room = store_.put(encoded(*news, self_)) && room;
    outlet.tiles().pop();
  }
  more_ = !outlet.settled();
  return room;
}

bool TileStream::wants(const StreamClient& client) const {
  return client.wants.wants(map_ == clients::TileMap::kOwn ? clients::Stream::kOwnTiles : clients::Stream::kTeamTiles);
}

void TileStream::begin(StreamClient& client) const {
  const auto& has = map_ == clients::TileMap::kOwn ? client.wants.own : client.wants.team;
  const bool known = has.session == session_ && has.epoch == store_.epoch() && has.version <= store_.version();
  cursor_of(client) = {.epoch = store_.epoch(), .version = known ? has.version : 0};
}

bool TileStream::up_to_date(const TileCursor& cursor) const {
  return (cursor.caught_up || more_) && cursor.epoch == store_.epoch() && store_.next_after(cursor.version) == nullptr;
}

bool TileStream::all_caught_up(ClientHub& hub) const {
  return std::ranges::all_of(hub.clients(),
                             [&](StreamClient& client) { return !wants(client) || up_to_date(cursor_of(client)); });
}

std::size_t TileStream::serve(ClientHub& hub, Time now, std::size_t records) {
  auto& clients = hub.clients();
  std::size_t sent = 0;
  for (std::size_t idle = 0; sent < records && idle < clients.size();) {
    StreamClient& client = clients[++turn_ % clients.size()];
    const bool took = serve_one(hub, client, now);
    idle = took ? 0 : idle + 1;
    sent += took ? 1 : 0;
  }
  return sent;
}

void TileStream::try_again(ClientHub& hub) const {
  for (StreamClient& client : hub.clients()) cursor_of(client).retry = {};
}

/// One record. False: the client wants none, or cannot take it now.
bool TileStream::serve_one(ClientHub& hub, StreamClient& client, Time now) {
  TileCursor& cursor = cursor_of(client);
  if (!wants(client) || up_to_date(cursor) || now < cursor.retry) return false;
  if (cursor.epoch != store_.epoch()) cursor = {.epoch = store_.epoch()};
  clients::TilesWriter writer({.map = map_, .session = session_, .epoch = store_.epoch()}, client.sequence, record_);
  std::uint64_t version = cursor.version;
  const TileStore::Tile* tile = store_.next_after(version);
  for (; tile != nullptr && writer.add(*tile); tile = store_.next_after(version)) version = tile->version;
  const bool caught_up = tile == nullptr && !more_;
  writer.finish(caught_up);
  if (!hub.try_send(client, record_)) {
    cursor.pause = std::clamp(2 * cursor.pause, kFirstPause, kLongestPause);
    cursor.retry = now + cursor.pause;
    return false;
  }
  cursor = {.epoch = cursor.epoch, .version = version, .caught_up = caught_up};
  return true;
}

}  // namespace cairn::app
