// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/gpio/config.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::gpio {

/// The normally closed contact of an e-stop: open means stop, and so does a broken wire. One edge, one open level, or
/// no level for kSilence stops. Release needs the contact closed for a while. The stop stays latched until rearm().
/// Pure: edges, levels and time in, decision out. A robot must have a second path that stops it.
class EStop {
 public:
  enum class Cause : std::uint8_t {
    kNotArmed,   ///< never armed since the start
    kOpened,     ///< the contact opened
    kEdgesLost,  ///< the kernel's queue overflowed: the contact may have opened in between
    kSilent,     ///< the level was not read for kSilence: the reader or the chip hangs
    kLineLost,   ///< the chip is gone or does not answer
  };
  /// What the line did.
  struct Counters {
    std::uint64_t edges = 0, opened = 0, edges_lost = 0;
    std::uint64_t unseen_edges = 0;  ///< the level changed without an edge
  };
  static constexpr Duration kSilence = std::chrono::milliseconds(100);

  explicit EStop(const Config& config);

  /// An edge that the kernel saw. `sequence` counts the edges of the line from 1; 0: not known. Stamps may be in the
  /// past.
  void edge(Time stamp, bool closed, std::uint32_t sequence);
  /// The level, to be read at every control tick.
  void level(Time now, bool closed);
  /// Reading the level failed.
  void lost(Time now);
  /// True while the robot must not move. Also stops when no level was read for kSilence.
  bool stopped(Time now);
  /// Ends a stop. Error kLinkDown with the cause: the contact must have been closed for Config::estop_rearm_ms. Nothing
  /// is allocated.
  Result<void> rearm(Time now);

  [[nodiscard]] bool released(Time now) const;  ///< closed for Config::estop_release_ms
  [[nodiscard]] Cause cause() const { return cause_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  void stop(Cause cause);
  void open();

  Duration release_, rearm_;
  bool latched_ = true;
  Cause cause_ = Cause::kNotArmed;
  bool closed_ = false;
  std::optional<Time> closed_since_, read_at_;
  std::uint32_t sequence_ = 0;
  Counters counters_;
};
[[nodiscard]] std::string_view to_string(EStop::Cause cause);

}  // namespace cairn::gpio
