// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/drive/can/can_frame.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::drive {

/// One line of candump's text (can-utils).
struct CandumpLine {
  std::optional<Time> stamp;   ///< as written: UTC, since the first frame (-tz) or since the last one (-td)
  std::string_view interface;  ///< in the line's memory; at most kMaxInterface characters
  CanFrame frame;
  std::optional<Direction> direction;  ///< only with -x: R and T, RX and TX
};

/// What candump -l counts its stamps in. Live frames are stamped in whole ones, too: a recording then holds what was
/// used.
using CandumpTick = std::chrono::microseconds;

inline constexpr std::size_t kMaxInterface = 15;
inline constexpr std::size_t kMaxCandumpLine = 1024;  ///< the longest FD line, in binary digits, has 660

/// Reads a line in any form that candump writes:
///   log      (1398128223.803317) can0 166#D0320009[ R|T]     -l, -L; 166#R4, 123##1… (FD), 123#…_F (raw DLC), dots
///   console  [(stamp)] can0 [RX - -] 166 [4] D0 32 00 09     -ta, -tA, -tz, -td or without; remote request,
///   ERRORFRAME,
///                                                            -a, -i, -S, -8, -c
/// Stamps have 0 … 9 decimals; the date of -tA is taken as UTC. Null for a line without a frame: empty, a comment (#),
/// DROPCOUNT, the explanation of an error frame (it begins with a tab). Errors: kMalformed with the column in `offset`,
/// kUnsupported (CAN XL), kLimit (a longer line).
[[nodiscard]] Result<std::optional<CandumpLine>> parse_candump(std::string_view line);

/// Appends the line that candump -l writes, with line feed: microseconds, upper-case digits, no dots. `utc` ≥ 0.
void append_candump(std::string& out, Time utc, std::string_view interface, const CanFrame& frame,
                    std::optional<Direction> direction = std::nullopt);

}  // namespace cairn::drive
