// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/config/config.hpp"
#include "hal/result.hpp"

namespace cairn::team_run {

/// What the emulated radio does to every IP packet between two robots; link.yaml has these fields. The defaults are
/// those of a bad link.
struct LinkConfig {
  double rate_bit_s = 2e6;  ///< of each robot's radio, IP headers included; 0: no limit
  double queue_ms = 300;    ///< a packet that would wait longer for the rate is dropped
  double loss = 0.2;        ///< share of packets, 0…1
  double delay_ms = 50;     ///< of every packet, after it was sent
  double jitter_ms = 100;   ///< delays are spread evenly over so much on both sides of delay_ms, never below 0
  double reorder = 0;       ///< share of packets that are not delayed, 0…1
  double duplicate = 0.05;  ///< share of packets that arrive twice, 0…1
  int seed = 1;             ///< the same seed gives the nth packet between two robots the same fate

  friend bool operator==(const LinkConfig&, const LinkConfig&) = default;
};
void declare(config::Section& section, LinkConfig& link);

/// "clean" is a link without loss or delay, and "radio" has the defaults. Any other name is a file. Errors: those of
/// config::load().
Result<LinkConfig> load_link(const std::string& name);

}  // namespace cairn::team_run
