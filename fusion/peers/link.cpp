// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/link.hpp"

#include <algorithm>
#include <utility>

namespace cairn::peers {
namespace {

constexpr double kNewest = 0.02;  // weight of the newest item in `loss`: that of about the last fifty

}  // namespace

bool Link::take(const Hello& hello, RobotId self, Time now) {
  if (hello.epoch < epoch || (hello.epoch == epoch && hello.stamp <= echo.stamp)) return false;
  if (hello.epoch != epoch) {  // it began anew, and may know nothing any more
    told = false;
    known.clear();
  }
  name = hello.name;
  epoch = hello.epoch;
  newest = hello.newest;
  voxel_um = hello.voxel_um;
  place = hello.place;
  echo = {0, hello.stamp, {}};
  echo_heard = now;
  if (hello.echo && hello.echo->robot == self) clock.add(hello.echo->stamp, hello.echo->age, hello.stamp, now);
  return true;
}

void Link::take(const Bodies& heard, Time now) {
  if (bodies && std::pair(heard.epoch, heard.stamp) <= std::pair(bodies->bodies.epoch, bodies->bodies.stamp)) return;
  bodies = Heard{heard, now - heard.age};
}

void Link::take(const Digest& digest) {
  told = true;
  for (const Digest::Layer& layer : digest.layers)
    if (known.size() < Digest::kMaxLayers || known.contains(layer.robot))
      known[layer.robot] = {.epoch = layer.epoch, .direct = layer.direct, .versions = layer.known};
}

void Link::settle_in_flight(const Digest& digest, Duration round_trip, Time now) {
  std::erase_if(in_flight, [&](const auto& sent) {
    const auto told_of = std::ranges::find(digest.layers, sent.first.first, &Digest::Layer::robot);
    if (told_of == digest.layers.end()) return false;
    const bool arrived = told_of->known.contains(sent.first.second), lost = sent.second + round_trip < now;
    if (arrived || lost) note_fate(arrived);
    return arrived || lost;
  });
}

void Link::give_up(Duration patience, bool lost, Time now) {
  std::erase_if(in_flight, [&](const auto& sent) {
    const bool overdue = sent.second + patience < now;
    if (overdue && lost) note_fate(false);
    return overdue;
  });
}

Duration Link::round_trip(const ExchangeConfig& config) const {
  return std::min(config.longest_way, clock.longest_way().value_or(config.longest_way)) + config.answer;
}

void Link::note_fate(bool arrived) { loss += kNewest * ((arrived ? 0 : 1) - loss); }

}  // namespace cairn::peers
