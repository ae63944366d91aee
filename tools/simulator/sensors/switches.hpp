// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/gpio/line_event.hpp"
#include "hal/time.hpp"

namespace cairn::simulator {

struct LineEdge {
  Time stamp{};
  gpio::LineEvent event;
};

/// When the operator releases the e-stop, since the start; the contact bounces for a few milliseconds.
inline constexpr Duration kEStopReleased = std::chrono::milliseconds(100);

/// The GPIO lines of one run, in the order of time: the e-stop's contact is open at the start and closes while the
/// robot still rests; the camera's trigger rises at every exposure of `rate_hz` from `start` on, for `pulse`.
[[nodiscard]] std::vector<LineEdge> line_edges(Time start, Time end, double rate_hz, Duration pulse,
                                               std::uint64_t seed);

/// The instant of exposure `n`; never two at the same nanosecond.
[[nodiscard]] Time exposure(Time start, double rate_hz, std::uint64_t n);

}  // namespace cairn::simulator
