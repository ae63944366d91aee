// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/gpio/config.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::gpio {

/// An e-stop's normally-closed contact: closed is well, open is stop, and so is a broken wire. Stopping needs one sign
/// (edge, level, or none at all for too long); release needs the contact closed for a while, and leaves the stop
/// latched until rearm(). Pure: edges, levels and time in, decision out. It is never the only path that stops the
/// robot.
class EStop {
 public:
  enum class Cause : std::uint8_t {
    kNotArmed,   ///< since the start
    kOpened,     ///< the contact
    kEdgesLost,  ///< the kernel's queue overflowed: it may have opened in between
    kSilent,     ///< the level was not read for kSilence: the reader or the chip hangs
    kLineLost,   ///< the chip is gone or does not answer
  };
  struct Counters {
    std::uint64_t edges = 0, opened = 0, edges_lost = 0;
    std::uint64_t unseen_edges = 0;  ///< the level had changed without an edge
  };
  static constexpr Duration kSilence = std::chrono::milliseconds(100);

  explicit EStop(const Config& config);

  /// An edge as the kernel saw it; `sequence` counts the line's edges from 1, 0: not known. Stamps may lie in the past.
  void edge(Time stamp, bool closed, std::uint32_t sequence);
  /// The level, read at every control tick.
  void level(Time now, bool closed);
  /// Reading failed.
  void lost(Time now);
  /// True while the robot must not move; looks at the time, too.
  bool stopped(Time now);
  /// Error kLinkDown with what is in the way: the contact must have been closed for Config::estop_rearm_ms.
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
