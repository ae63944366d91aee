// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/config/config.hpp"
#include "hal/result.hpp"

namespace cairn::team {

/// What the emulated radio does to every IP packet between two robots; a file as link.yaml. The defaults are a bad
/// link.
struct LinkConfig {
  double rate_bit_s = 2e6;
  double queue_ms = 300;
  double loss = 0.2;
  double delay_ms = 50;
  double jitter_ms = 100;
  double reorder = 0;
  double duplicate = 0.05;
  int seed = 1;

  friend bool operator==(const LinkConfig&, const LinkConfig&) = default;
};
void declare(config::Section& section, LinkConfig& link);

/// "clean": a link that does nothing; "radio": the defaults; otherwise a file. Errors: those of config::load.
Result<LinkConfig> load_link(const std::string& name);

}  // namespace cairn::team
