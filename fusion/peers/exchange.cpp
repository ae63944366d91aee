// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/exchange.hpp"

#include <utility>

namespace cairn::peers {

Exchange::Exchange(RobotId self, std::string name, Epoch epoch, const ExchangeConfig& config)
    : config_(config),
      self_{.id = self, .name = std::move(name)},
      layers_(self, epoch,
              {.robots = config.max_robots, .bytes = config.max_bytes_per_robot, .spare_bytes = config.spare_bytes}),
      links_(config.max_robots, config.lease),
      sender_(config) {}

bool Exchange::say(ItemId id, std::span<const std::byte> payload) { return layers_.say(id, payload); }

void Exchange::begin(Epoch epoch) {
  layers_.begin(epoch);
  links_.forget_in_flight(self_.id);
  self_.place.reset();
  self_.bodies.reset();
}

void Exchange::set_bodies(Bodies bodies, Time seen) {
  bodies.stamp = seen;
  self_.bodies = std::move(bodies);
}

void Exchange::send(Time now, std::vector<Outgoing>& out) {
  const StatusMessages status(config_, self_, layers_, links_, now);
  sender_.send({.now = now,
                .status = status,
                .layers = layers_.all(),
                .links = links_,
                .interest_of = interest_of_,
                .out = out});
}

Result<void> Exchange::receive(std::span<const std::byte> datagram, Time now) {
  const auto decoded = decode_datagram(datagram);
  const RobotId sender = decoded ? decoded->sender : sender_of(datagram);
  if (sender == 0) return decoded ? Error{Errc::kMalformed, "a datagram of no robot"} : decoded.error();
  if (sender == self_.id)
    return Error{Errc::kMalformed, "another robot has this robot's id", {}, {}, "give each its own"};
  Link* link = links_.open(sender);
  if (link == nullptr) return Error{Errc::kLimit, "more robots than are listened to"};
  if (link->conduct.banned(now)) return Error{Errc::kLinkDown, "the peer sent too many invalid datagrams"};
  if (!decoded) {
    ++link->refused;
    link->unsupported += decoded.error().code == Errc::kUnsupported ? 1 : 0;
    link->conduct.fault(now);
    return decoded.error();
  }
  if (!hears(sender, now)) link->next_full = link->next_digest = Time::min();  // new, or back: it may know nothing
  link->last_heard = now;
  link->received_bytes += datagram.size();
  return take(sender, *link, *decoded, now);
}

Result<void> Exchange::take(RobotId sender, Link& link, const Datagram& datagram, Time now) {
  if (datagram.hello) {
    if (!link.take(*datagram.hello, self_.id, now)) return {};
    layers_.hear_of(sender, datagram.hello->epoch);
  }
  if (!alike(link)) return {};
  if (datagram.bodies) link.take(*datagram.bodies, now);
  if (!datagram.digest.layers.empty()) take(link, datagram.digest, now);
  return datagram.items ? take(link, *datagram.items) : Result<void>{};
}

void Exchange::take(Link& link, const Digest& digest, Time now) {
  link.take(digest);
  for (const Digest::Layer& layer : digest.layers) {
    const bool newer = layer.epoch == epoch() && layer.known.last() > layers_.own().holding.newest();
    if (layer.robot != self_.id)
      layers_.hear_of(layer.robot, layer.epoch);
    else if (layer.epoch > epoch() || newer)
      outdo(layer.epoch);
  }
  link.settle_in_flight(digest, link.round_trip(config_), now);
}

/// The robot has forgotten which epoch it was in, or what it published in it.
void Exchange::outdo(Epoch epoch) {
  layers_.outdo(epoch);
  links_.forget_in_flight(self_.id);
}

Result<void> Exchange::take(Link& link, const Items& items) {
  if (items.robot == self_.id) return {};  // from before this robot's last beginning
  const LayerStore::Taken taken = layers_.take(items);
  if (!taken.wanted) return {};
  link.owed.insert(items.robot);  // also if nothing is new: the sender does not know that it was known
  link.received_items += items.updates.size();
  link.repeated_items += taken.repeated;
  if (taken.full)
    return Error{
        Errc::kLimit,
        "a robot's map is larger than what is kept of it: parts of it are left out",
        {},
        {},
        "robot " + std::to_string(items.robot) + "; larger voxels take less: mapping.resolution_m, on all robots"};
  if (taken.fresh > 0) links_.owe(items.robot);
  return {};
}

}  // namespace cairn::peers
