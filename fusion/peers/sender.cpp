// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/sender.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace cairn::peers {
namespace {

constexpr std::size_t kManyGaps = 8;   // ranges of superseded versions that are worth a datagram of their own
constexpr double kBadLink = 0.1;       // share of items that are lost
constexpr double kDigestShare = 0.25;  // of the bytes, that digests take at most

}  // namespace

void Sender::send(const Round& round) {
  budget_.refill(round.now);
  if (round.now >= next_announcement_) announce(round);
  send_bodies(round);
  send_items(round);
  send_statuses(round);
}

/// They are worth nothing later: where the bytes do not last, the next ones will tell.
void Sender::send_bodies(const Round& round) {
  for (auto& [peer, link] : round.links.all()) {
    if (!round.links.hears(peer, round.now)) continue;
    const auto datagram = round.status.bodies(link.bodies_sent);
    if (!datagram) continue;
    auto bytes = encode(*datagram).bytes;
    if (cost_of(bytes) > budget_.left()) continue;
    budget_.spend(cost_of(bytes));
    link.bodies_sent = datagram->bodies->stamp;
    link.sent_bytes += bytes.size();
    link.sent_bodies_bytes += bytes.size() + config_.overhead_bytes;
    round.out.push_back({.to = peer, .bytes = std::move(bytes)});
  }
}

void Sender::announce(const Round& round) {
  const Datagram datagram = round.status.announcement();
  round.out.push_back({.to = 0, .bytes = encode(datagram).bytes});
  const auto& bytes = round.out.back().bytes;
  Links& links = round.links.all();
  for (auto& [peer, link] : links) note_status(link, datagram, bytes.size(), round);
  const double copies = std::max(1.0, static_cast<double>(links.size()));  // for everyone is for each
  budget_.spend(copies * cost_of(bytes));
  next_announcement_ = round.now + (links.empty() ? config_.hello_period : config_.announcement_period);
}

/// In turn, from the peer that the bytes did not last for.
void Sender::send_items(const Round& round) {
  Links& links = round.links.all();
  auto link = links.lower_bound(next_peer_);
  for (std::size_t i = 0; i < links.size(); ++i, ++link) {
    if (link == links.end()) link = links.begin();
    next_peer_ = link->first;
    if (budget_.left() < static_cast<double>(kMaxDatagram + config_.overhead_bytes)) break;
    // Before its first digest nobody knows what the peer lacks; guessing would send everything twice.
    if (!round.links.hears(link->first, round.now) || !link->second.told) continue;
    for (const auto& [robot, layer] : round.layers)
      if (robot != link->first) send_layer(round, {.peer = link->first, .robot = robot, .layer = layer}, link->second);
  }
}

void Sender::send_statuses(const Round& round) {
  for (auto& [peer, link] : round.links.all()) {
    if (round.now < link.next_status) continue;
    const Datagram datagram = round.status.status(peer, link);
    round.out.push_back({.to = peer, .bytes = encode(datagram).bytes});
    note_status(link, datagram, round.out.back().bytes.size(), round);
    budget_.spend(cost_of(round.out.back().bytes));
  }
}

void Sender::send_layer(const Round& round, const Delivery& delivery, Link& link) {
  give_up_overdue(link, round.now);
  Missing missing = missing_items(delivery, link, round.status.sender(), round.interest_of);
  const bool waited = round.now >= link.last_items + config_.gather;
  if (missing.updates.empty() && (missing.superseded.ranges().size() < kManyGaps || !waited)) return;
  Datagram next = round.status.companion(delivery.peer, link);
  next.items = {.robot = delivery.robot,
                .epoch = delivery.layer.epoch,
                .superseded = std::move(missing.superseded),
                .updates = std::move(missing.updates)};
  do {
    auto& updates = next.items->updates;
    auto [bytes, count] = encode(next);
    if (cost_of(bytes) > budget_.left()) return;
    if (count == updates.size() && !waited) return;  // there is room for more
    for (const ItemUpdate& update : std::span(updates).first(count))
      link.in_flight[{delivery.robot, update.version}] = round.now;
    note_status(link, next, bytes.size(), round);
    budget_.spend(cost_of(bytes));
    link.sent_bytes += bytes.size();
    link.sent_items += count;
    link.last_items = round.now;
    round.out.push_back({.to = delivery.peer, .bytes = std::move(bytes)});
    updates.erase(updates.begin(), updates.begin() + static_cast<std::ptrdiff_t>(count));
    next.hello.reset();
    next.digest.layers.clear();
    next.items->superseded.clear();
  } while (!next.items->updates.empty());
}

/// A digest would have told of these by now. On a bad link with bytes to spare, it is better to send a few
/// items twice than to wait for the digest. Never to wait would send a third of all items twice.
void Sender::give_up_overdue(Link& link, Time now) const {
  const bool hasten = link.loss > kBadLink && budget_.left() > budget_.per_second() / 2;
  const Duration until_digest = hasten ? config_.digest_period / 2 : config_.digest_period;
  link.give_up(link.round_trip(config_) + until_digest + config_.answer, !hasten, now);
}

/// A datagram of so many bytes goes to the peer: when its next status and digests are due.
void Sender::note_status(Link& link, const Datagram& datagram, std::size_t bytes, const Round& round) const {
  for (const Digest::Layer& layer : datagram.digest.layers) link.owed.erase(layer.robot);
  if (!datagram.hello) return;
  link.next_status = round.now + config_.hello_period;
  if (datagram.digest.layers.empty()) return;
  const double share = budget_.per_second() * kDigestShare;
  const auto all = static_cast<double>(round.links.all().size() * (bytes + config_.overhead_bytes));
  link.next_digest = round.now + std::max(config_.digest_period, from_seconds(all / share));
  if (round.now >= link.next_full) link.next_full = round.now + config_.digest_repeat;
}

}  // namespace cairn::peers
