// SPDX-License-Identifier: Apache-2.0
// What an Exchange sends; what it makes of what it hears is in exchange.cpp.
#include <algorithm>
#include <utility>

#include "fusion/peers/datagrams/datagram_part.hpp"
#include "fusion/peers/exchange.hpp"

namespace cairn::peers {
namespace {

constexpr std::size_t kLookedAt = 1024;  // missing items among which the most urgent are found
constexpr std::size_t kManyGaps = 8;     // in what a peer knows, of which nothing is missing: worth a datagram
constexpr double kBadLink = 0.1;         // share of items that are lost
constexpr double kDigestShare = 0.25;    // of the bytes, at most

}  // namespace

/// Who is new hears a robot's announcement; who is known gets the same along with what it is sent, or alone.
void Exchange::send(Time now, std::vector<Outgoing>& out) {
  const auto rate = static_cast<double>(config_.bytes_per_second);
  if (last_send_ != Time::min()) bytes_ = std::min(rate, bytes_ + rate * to_seconds(now - last_send_));
  last_send_ = now;
  if (now >= next_announcement_) announce(now, out);

  auto link = links_.lower_bound(next_peer_);
  for (std::size_t i = 0; i < links_.size(); ++i, ++link) {
    if (link == links_.end()) link = links_.begin();
    next_peer_ = link->first;
    if (bytes_ < static_cast<double>(kMaxDatagram + config_.overhead_bytes)) break;
    if (hears(link->first, now)) send_items(now, link->first, link->second, out);
  }
  for (auto& [peer, due] : links_)
    if (now >= due.next_status) send_status(now, peer, due, out);
}

void Exchange::announce(Time now, std::vector<Outgoing>& out) {
  const Datagram datagram{self_, hello(now, 0), digest(now, std::nullopt), {}};
  out.push_back({0, encode(datagram).bytes});
  for (auto& [peer, link] : links_) note_told(link, now, datagram, out.back().bytes.size());
  const double copies = std::max(1.0, static_cast<double>(links_.size()));  // for everyone is for each
  bytes_ -= copies * static_cast<double>(out.back().bytes.size() + config_.overhead_bytes);
  next_announcement_ = now + (links_.empty() ? config_.hello_period : config_.announcement_period);
}

void Exchange::send_status(Time now, RobotId peer, Link& link, std::vector<Outgoing>& out) {
  const Datagram datagram = status(now, peer, link);
  out.push_back({peer, encode(datagram).bytes});
  note_told(link, now, datagram, out.back().bytes.size());
  bytes_ -= static_cast<double>(out.back().bytes.size() + config_.overhead_bytes);
}

Datagram Exchange::status(Time now, RobotId peer, const Link& link) const {
  Datagram status{self_, hello(now, peer), {}, {}};
  if (now >= link.next_digest)
    status.digest = digest(now, now >= link.next_full ? std::nullopt : std::optional(link.owed));
  return status;
}

/// What goes along with items: a status that is due soon, or news of what is known; nothing that takes much of their
/// room.
Datagram Exchange::companion(Time now, RobotId peer, const Link& link) const {
  const bool due_soon = now + config_.hello_period / 2 >= link.next_status;
  Datagram datagram = due_soon ? status(now, peer, link) : Datagram{self_, {}, digest(now, link.owed), {}};
  const auto bytes = encode({self_, {}, datagram.digest, {}}).bytes.size();
  return bytes <= kHeaderBytes + kMaxRangeBytes ? datagram : Datagram{self_, {}, {}, {}};
}

/// A datagram of so many bytes goes to the peer.
void Exchange::note_told(Link& link, Time now, const Datagram& datagram, std::size_t bytes) const {
  for (const Digest::Layer& layer : datagram.digest.layers) link.owed.erase(layer.robot);
  if (!datagram.hello) return;
  link.next_status = now + config_.hello_period;
  if (datagram.digest.layers.empty()) return;
  const double share = static_cast<double>(config_.bytes_per_second) * kDigestShare;
  const auto all = static_cast<double>(links_.size() * (bytes + config_.overhead_bytes));
  link.next_digest = now + std::max(config_.digest_period, from_seconds(all / share));
  if (now >= link.next_full) link.next_full = now + config_.digest_repeat;
}

/// Which a peer can tell the time from, if it was heard.
Hello Exchange::hello(Time now, RobotId peer) const {
  const Layer& own = layers_.at(self_);
  Hello hello{own.epoch, own.holding.newest(), now, name_, {}, config_.voxel_um, place_};
  if (const auto link = links_.find(peer); link != links_.end() && link->second.echo.stamp != Time::min())
    hello.echo = {peer, link->second.echo.stamp, now - link->second.echo_heard};
  return hello;
}

/// Of everyone, or of some.
Digest Exchange::digest(Time now, const std::optional<std::set<RobotId>>& robots) const {
  Digest digest;
  for (const auto& [robot, layer] : layers_)
    if (!robots || robots->contains(robot))
      digest.layers.push_back({robot, layer.epoch, hears(robot, now), layer.holding.known()});
  for (const auto& [robot, link] : links_)
    if (!robots && hears(robot, now) && !layers_.contains(robot)) digest.layers.push_back({robot, 0, true, {}});
  return digest;
}

void Exchange::send_items(Time now, RobotId peer, Link& link, std::vector<Outgoing>& out) {
  if (!link.told) return;  // it will say what it knows; guessing would send everything twice
  for (const auto& [robot, layer] : layers_)
    if (robot != peer) send_layer(now, {peer, robot, layer}, link, out);
}

/// Most urgent first; nothing where the peer hears that robot itself, or holds a later epoch.
Missing Exchange::missing_at(const Link& link, const Address& address) const {
  const auto known = link.known.find(address.robot);
  const bool none = known == link.known.end() || known->second.epoch < address.layer.epoch;
  if (known != link.known.end() && known->second.epoch > address.layer.epoch) return {};
  if (address.robot != self_ && known != link.known.end() && known->second.direct) return {};
  const VersionSet at_peer = none ? VersionSet{} : known->second.versions;
  Missing missing = address.layer.holding.missing(at_peer, kLookedAt + link.in_flight.size());
  const auto interest = interest_ ? std::optional(interest_(address.peer, address.robot)) : std::nullopt;
  if (interest) add_near_by(missing.updates, *interest, address, at_peer);
  std::erase_if(missing.updates, [&](const ItemUpdate& update) {
    return link.in_flight.contains({address.robot, update.version});
  });
  if (interest) interest->sort(missing.updates);
  return missing;
}

/// To updates by ascending version, of which the last are the newest that were looked at.
void Exchange::add_near_by(std::vector<ItemUpdate>& updates, const Interest& interest, const Address& address,
                           const VersionSet& at_peer) const {
  if (updates.size() < kLookedAt) return;  // that is all
  const Version looked_at = updates.back().version;
  for (const ItemUpdate& update : address.layer.holding.missing_of(interest.near_by(), at_peer))
    if (update.version > looked_at) updates.push_back(update);
}

void Exchange::send_layer(Time now, const Address& address, Link& link, std::vector<Outgoing>& out) {
  // A digest would have told by now. On a bad link with bytes to spare, sending a few twice is better than waiting for
  // it; not waiting for any sends a third of all twice.
  const bool hasten = link.loss > kBadLink && bytes_ > static_cast<double>(config_.bytes_per_second) / 2;
  const Duration patience =
      way_of(link) + (hasten ? config_.digest_period / 2 : config_.digest_period) + config_.answer;
  std::erase_if(link.in_flight, [&](const auto& sent) {
    const bool overdue = sent.second + patience < now;
    if (overdue && !hasten) link.note_fate(false);
    return overdue;
  });
  Missing missing = missing_at(link, address);
  const bool waited = now >= link.last_items + config_.gather;
  if (missing.updates.empty() && (missing.superseded.ranges().size() < kManyGaps || !waited)) return;
  Datagram next = companion(now, address.peer, link);
  next.items = {address.robot, address.layer.epoch, std::move(missing.superseded), std::move(missing.updates)};
  do {
    auto [bytes, count] = encode(next);
    const auto cost = static_cast<double>(bytes.size() + config_.overhead_bytes);
    if (cost > bytes_) return;
    auto& updates = next.items->updates;
    if (count == updates.size() && !waited) return;  // there is room for more
    for (const ItemUpdate& update : std::span(updates).first(count))
      link.in_flight[{address.robot, update.version}] = now;
    note_told(link, now, next, bytes.size());
    bytes_ -= cost;
    link.sent_bytes += bytes.size();
    link.sent_items += count;
    link.last_items = now;
    out.push_back({address.peer, std::move(bytes)});
    updates.erase(updates.begin(), updates.begin() + static_cast<std::ptrdiff_t>(count));
    next = {self_, {}, {}, Items{address.robot, address.layer.epoch, {}, std::move(updates)}};
  } while (!next.items->updates.empty());
}

}  // namespace cairn::peers
