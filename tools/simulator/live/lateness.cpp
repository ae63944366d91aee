// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/lateness.hpp"

#include <cstdio>

namespace cairn::simulator {

std::optional<std::string> Lateness::take_words(Time now) {
  if (said_ && now - *said_ < kEvery) return std::nullopt;
  const Duration late = worst_;
  const std::uint64_t lost = left_out_;
  worst_ = {};
  left_out_ = 0;
  if (late <= kTolerated && lost == 0) {
    said_.reset();
    return std::nullopt;
  }
  said_ = now;
  char text[160];
  std::snprintf(
      text, sizeof text,
      "the world is up to %.0f ms late, %llu LiDAR packets were left out: the machine is too slow or too busy",
      1e3 * to_seconds(late), static_cast<unsigned long long>(lost));
  return text;
}

}  // namespace cairn::simulator
