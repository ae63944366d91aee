// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/exchange.hpp"

#include <algorithm>
#include <utility>

namespace cairn::peers {
namespace {

constexpr std::size_t kLookedAt = 1024;                     // missing items among which the most urgent are found
constexpr Duration kTick = std::chrono::milliseconds(200);  // robots do not answer at once
constexpr std::size_t kManyGaps = 8;   // in what a peer knows, of which nothing is missing: worth a datagram
constexpr double kBadLink = 0.1;       // share of items that are lost
constexpr std::size_t kEchoes = 2;     // in a hello
constexpr double kDigestShare = 0.25;  // of the bytes, at most

}  // namespace

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
  if (!hears(sender, now)) last_full_digest_ = Time::min();  // new, or back: it wants to know what this one has
  link->last_heard = now;
  link->received_bytes += datagram.size();
  if (!alike(*link) && !std::holds_alternative<Hello>(decoded->content)) return {};
  return std::visit([&](const auto& content) { return take(sender, *link, content, now); }, decoded->content);
}

Result<void> Exchange::take(RobotId sender, Link& link, const Hello& hello, Time now) {
  if (hello.epoch < link.epoch || (hello.epoch == link.epoch && hello.stamp <= link.echo.stamp)) return {};  // late
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
  for (const Hello::Echo& echo : hello.echoes)
    if (echo.robot == self_) link.clock.add(echo.stamp, echo.age, hello.stamp, now);
  return {};
}

/// Time for a datagram and whatever answers it.
Duration Exchange::way_of(const Link& link) const {
  return std::min(config_.longest_way, link.clock.longest_way().value_or(config_.longest_way)) + kTick;
}

Result<void> Exchange::take(RobotId /*sender*/, Link& link, const Digest& digest, Time now) {
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
  return {};
}

Result<void> Exchange::take(RobotId /*sender*/, Link& link, const Items& items, Time /*now*/) {
  if (items.robot == self_) return {};  // from before this robot's last beginning
  Layer* layer = layer_of(items.robot, items.epoch);
  if (layer == nullptr) return {};
  to_digest_.insert(items.robot);  // also where nothing is new: the sender does not know that it was known
  layer->holding.settle(items.superseded);
  link.received_items += items.updates.size();
  for (const ItemUpdate& update : items.updates) {
    const auto taken = layer->holding.take(update);
    if (taken == Holding::Taken::kFull)
      return Error{Errc::kLimit, "a robot says more than is kept of one", {}, {}, std::to_string(items.robot)};
    if (taken == Holding::Taken::kNew) changes_[items.robot].items.insert(update.id);
    if (taken == Holding::Taken::kKnown) ++link.repeated_items;
  }
  return {};
}

void Exchange::send(Time now, std::vector<Outgoing>& out) {
  const auto rate = static_cast<double>(config_.bytes_per_second);
  if (last_send_ != Time::min()) bytes_ = std::min(rate, bytes_ + rate * to_seconds(now - last_send_));
  last_send_ = now;
  if (now >= next_hello_) send_hello(now, out);
  if (!links_.empty() && now >= next_digest_) send_digest(now, out);

  auto link = links_.lower_bound(next_peer_);
  for (std::size_t i = 0; i < links_.size(); ++i, ++link) {
    if (link == links_.end()) link = links_.begin();
    next_peer_ = link->first;
    if (bytes_ < static_cast<double>(kMaxDatagram + config_.overhead_bytes)) return;
    if (hears(link->first, now)) send_items(now, link->first, link->second, out);
  }
}

/// What goes to everyone goes to each.
std::size_t Exchange::send_to_all(std::vector<std::byte> bytes, std::vector<Outgoing>& out) {
  const std::size_t all = std::max<std::size_t>(1, links_.size()) * (bytes.size() + config_.overhead_bytes);
  bytes_ -= static_cast<double>(all);
  out.push_back({0, std::move(bytes)});
  return all;
}

void Exchange::send_hello(Time now, std::vector<Outgoing>& out) {
  const Layer& own = layers_.at(self_);
  Hello hello{own.epoch, own.holding.newest(), now, name_, {}, config_.voxel_um, place_};
  auto link = links_.upper_bound(next_echo_);
  for (std::size_t i = 0; i < std::min(links_.size(), kEchoes); ++i, ++link) {
    if (link == links_.end()) link = links_.begin();
    next_echo_ = link->first;
    if (hears(link->first, now) && link->second.echo.stamp != Time::min())
      hello.echoes.push_back({link->first, link->second.echo.stamp, now - link->second.echo_heard});
  }
  send_to_all(encode(self_, hello), out);
  next_hello_ = now + config_.hello_period;
}

void Exchange::send_digest(Time now, std::vector<Outgoing>& out) {
  const bool full = last_full_digest_ == Time::min() || now >= last_full_digest_ + config_.digest_repeat;
  Digest digest;
  for (const auto& [robot, layer] : layers_)
    if (full || to_digest_.contains(robot))
      digest.layers.push_back({robot, layer.epoch, hears(robot, now), layer.holding.known()});
  for (const auto& [robot, link] : links_)
    if (full && hears(robot, now) && !layers_.contains(robot)) digest.layers.push_back({robot, 0, true, {}});
  if (digest.layers.empty()) return;
  const std::size_t cost = send_to_all(encode(self_, digest), out);
  const double share = static_cast<double>(config_.bytes_per_second) * kDigestShare;
  next_digest_ = now + std::max(config_.digest_period, from_seconds(static_cast<double>(cost) / share));
  if (full) last_full_digest_ = now;
  to_digest_.clear();
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
  const Duration patience = way_of(link) + (hasten ? config_.digest_period / 2 : config_.digest_period) + kTick;
  std::erase_if(link.in_flight, [&](const auto& sent) {
    const bool overdue = sent.second + patience < now;
    if (overdue && !hasten) link.note_fate(false);
    return overdue;
  });
  Missing missing = missing_at(link, address);
  const bool waited = now >= link.last_items + config_.gather;
  if (missing.updates.empty() && (missing.superseded.ranges().size() < kManyGaps || !waited)) return;
  Items next{address.robot, address.layer.epoch, std::move(missing.superseded), std::move(missing.updates)};
  do {
    std::size_t count = 0;
    auto datagram = encode(self_, next, count);
    const auto cost = static_cast<double>(datagram.size() + config_.overhead_bytes);
    if (cost > bytes_) return;
    if (count == next.updates.size() && !waited) return;  // there is room for more
    for (const ItemUpdate& update : std::span(next.updates).first(count))
      link.in_flight[{address.robot, update.version}] = now;
    bytes_ -= cost;
    link.sent_bytes += datagram.size();
    link.sent_items += count;
    link.last_items = now;
    out.push_back({address.peer, std::move(datagram)});
    next.updates.erase(next.updates.begin(), next.updates.begin() + static_cast<std::ptrdiff_t>(count));
    next.superseded.clear();
  } while (!next.updates.empty());
}

}  // namespace cairn::peers
