// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/exchange.hpp"

#include <algorithm>
#include <utility>

namespace cairn::peers {
Exchange::Exchange(RobotId self, std::string name, Epoch epoch, const ExchangeConfig& config)
    : self_(self), name_(std::move(name)), config_(config) {
  begin(epoch);
}

void Exchange::begin(Epoch epoch) {
  layers_.insert_or_assign(self_, Layer{epoch, Holding(config_.max_bytes_per_robot)});
  place_.reset();
  changes_[self_] = {true, {}};
  for (auto& [robot, link] : links_)
    std::erase_if(link.in_flight, [&](const auto& sent) { return sent.first.first == self_; });
}

bool Exchange::say(ItemId id, std::span<const std::byte> payload) {
  if (!layers_.at(self_).holding.say(id, payload)) return false;
  changes_[self_].items.insert(id);
  return true;
}

bool Exchange::hears(RobotId robot, Time now) const {
  const auto link = links_.find(robot);
  return link != links_.end() && link->second.last_heard + config_.lease >= now;
}

Changes Exchange::take_changes() { return std::exchange(changes_, {}); }

Link* Exchange::link_of(RobotId robot) {
  const auto link = links_.find(robot);
  if (link != links_.end()) return &link->second;
  return links_.size() < config_.max_robots ? &links_[robot] : nullptr;
}

/// Says everything again in a later epoch than the one that others know.
void Exchange::outdo(Epoch epoch) {
  const Holding said = std::move(layers_.at(self_).holding);
  const auto place = place_;
  begin(std::min(epoch + 1, kLastEpoch));
  place_ = place;
  for (const auto& [id, item] : said.items()) say(id, item.payload);
}

/// What a robot said before its present epoch is void, even where it has said nothing since.
void Exchange::hear_of(RobotId robot, Epoch epoch) {
  const auto layer = layers_.find(robot);
  if (layer != layers_.end() && layer->second.epoch < epoch) (void)layer_of(robot, epoch);
}

/// Where the items of a robot's epoch go; null where they are of an earlier one, or of one robot too many.
Layer* Exchange::layer_of(RobotId robot, Epoch epoch) {
  auto layer = layers_.find(robot);
  if (layer == layers_.end() && layers_.size() > config_.max_robots) return nullptr;
  if (layer != layers_.end() && layer->second.epoch >= epoch)
    return layer->second.epoch == epoch ? &layer->second : nullptr;
  changes_[robot] = {true, {}};
  return &layers_.insert_or_assign(robot, Layer{epoch, Holding(config_.max_bytes_per_robot)}).first->second;
}

Result<void> Exchange::receive(std::span<const std::byte> datagram, Time now) {
  const auto decoded = decode_datagram(datagram);
  const RobotId sender = decoded ? decoded->sender : sender_of(datagram);
  if (sender == 0) return decoded ? Error{Errc::kMalformed, "a datagram of no robot"} : decoded.error();
  if (sender == self_) return Error{Errc::kMalformed, "another robot has this robot's id", {}, {}, "give each its own"};
  Link* link = link_of(sender);
  if (link == nullptr) return Error{Errc::kLimit, "more robots than are listened to"};
  if (link->conduct.banned(now)) return Error{Errc::kLinkDown, "the peer sent too much that cannot be"};
  if (!decoded) {
    ++link->refused;
    link->unsupported += decoded.error().code == Errc::kUnsupported ? 1 : 0;
    link->conduct.fault(now);
    return decoded.error();
  }
  if (!hears(sender, now)) link->next_full = link->next_digest = Time::min();  // new, or back: it may know nothing
  link->last_heard = now;
  link->received_bytes += datagram.size();
  if (decoded->hello && !take(sender, *link, *decoded->hello, now)) return {};
  if (!alike(*link)) return {};
  if (!decoded->digest.layers.empty()) take(*link, decoded->digest, now);
  return decoded->items ? take(*link, *decoded->items) : Result<void>{};
}

/// False where it is late: the link knows a newer one.
bool Exchange::take(RobotId sender, Link& link, const Hello& hello, Time now) {
  if (hello.epoch < link.epoch || (hello.epoch == link.epoch && hello.stamp <= link.echo.stamp)) return false;
  if (hello.epoch != link.epoch) {  // it began anew, and may know nothing any more
    link.told = false;
    link.known.clear();
  }
  hear_of(sender, hello.epoch);
  link.name = hello.name;
  link.epoch = hello.epoch;
  link.newest = hello.newest;
  link.voxel_um = hello.voxel_um;
  link.place = hello.place;
  link.echo = {0, hello.stamp, {}};
  link.echo_heard = now;
  if (hello.echo && hello.echo->robot == self_) link.clock.add(hello.echo->stamp, hello.echo->age, hello.stamp, now);
  return true;
}

/// Time for a datagram and whatever answers it.
Duration Exchange::way_of(const Link& link) const {
  return std::min(config_.longest_way, link.clock.longest_way().value_or(config_.longest_way)) + config_.answer;
}

void Exchange::take(Link& link, const Digest& digest, Time now) {
  link.told = true;
  for (const Digest::Layer& layer : digest.layers) {
    if (link.known.size() < Digest::kMaxLayers || link.known.contains(layer.robot))
      link.known[layer.robot] = {layer.epoch, layer.direct, layer.known};
    if (layer.robot != self_) {
      hear_of(layer.robot, layer.epoch);
    } else if (layer.epoch > epoch() ||
               (layer.epoch == epoch() && layer.known.last() > layers_.at(self_).holding.newest())) {
      outdo(layer.epoch);
    }
  }
  std::erase_if(link.in_flight, [&](const auto& sent) {
    const auto told = std::ranges::find(digest.layers, sent.first.first, &Digest::Layer::robot);
    if (told == digest.layers.end()) return false;
    const bool arrived = told->known.contains(sent.first.second), lost = sent.second + way_of(link) < now;
    if (arrived || lost) link.note_fate(arrived);
    return arrived || lost;
  });
}

Result<void> Exchange::take(Link& link, const Items& items) {
  if (items.robot == self_) return {};  // from before this robot's last beginning
  Layer* layer = layer_of(items.robot, items.epoch);
  if (layer == nullptr) return {};
  link.owed.insert(items.robot);  // also where nothing is new: the sender does not know that it was known
  layer->holding.settle(items.superseded);
  link.received_items += items.updates.size();
  bool news = false;
  for (const ItemUpdate& update : items.updates) {
    const auto taken = layer->holding.take(update);
    if (taken == Holding::Taken::kFull)
      return Error{Errc::kLimit, "a robot says more than is kept of one", {}, {}, std::to_string(items.robot)};
    if (taken == Holding::Taken::kNew) changes_[items.robot].items.insert(update.id);
    news = news || taken == Holding::Taken::kNew;
    if (taken == Holding::Taken::kKnown) ++link.repeated_items;
  }
  for (auto& [robot, other] : links_)
    if (news) other.owed.insert(items.robot);
  return {};
}

}  // namespace cairn::peers
