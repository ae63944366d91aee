// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "hal/time.hpp"

namespace cairn::simulator {

/// Says how late a world is that should play in real time, once a second at most. Pure.
class Lateness {
 public:
  static constexpr Duration kTolerated = std::chrono::milliseconds(20), kEvery = std::chrono::seconds(1);

  /// A packet was sent so long after it was due.
  void sent(Duration late) { worst_ = std::max(worst_, late); }
  void left_out(std::uint64_t packets) { left_out_ += packets; }
  /// What is to be said at `now`; null: nothing.
  std::optional<std::string> take_words(Time now);

 private:
  std::optional<Time> said_;
  Duration worst_{};
  std::uint64_t left_out_ = 0;
};

}  // namespace cairn::simulator
