// SPDX-License-Identifier: Apache-2.0
#include "tools/team/network/link_config.hpp"

namespace cairn::team_run {

void declare(config::Section& s, LinkConfig& link) {
  s.number("rate_bit_s", link.rate_bit_s, {0, 1e9}, "bit/s",
           "what a robot's radio sends, IP headers included; 0: no limit");
  s.number("queue_ms", link.queue_ms, {1, 10'000}, "ms", "packets that would wait longer for the rate are dropped");
  s.number("loss", link.loss, {0, 1}, "", "share of packets that are lost");
  s.number("delay_ms", link.delay_ms, {0, 10'000}, "ms", "of every packet, after it was sent");
  s.number("jitter_ms", link.jitter_ms, {0, 10'000}, "ms",
           "delays are spread evenly over so much on both sides of delay_ms (never below 0), each packet's for itself: "
           "packets overtake each other");
  s.number("reorder", link.reorder, {0, 1}, "",
           "share of packets that are not delayed at all, and overtake the others");
  s.number("duplicate", link.duplicate, {0, 1}, "",
           "share of packets that arrive twice, each after a delay of its own");
  s.integer("seed", link.seed, {0, 2'147'483'647}, "",
            "same seed, same fate of the n-th packet from one robot to another");
}

Result<LinkConfig> load_link(const std::string& name) {
  LinkConfig link;
  if (name == "radio") return link;
  if (name == "clean") return LinkConfig{0, link.queue_ms, 0, 0, 0, 0, 0, link.seed};
  config::Section section;
  declare(section, link);
  if (const auto loaded = config::load(name, section); !loaded) {
    if (loaded.error().code != Errc::kNotFound) return loaded.error();
    return Error{Errc::kInvalidConfig, "there is no such link", name, {}, "name a link.yaml, radio or clean"};
  }
  return link;
}

}  // namespace cairn::team_run
