// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

namespace cairn::app {

/// The people around a robot that follows them. Not within LiveView, where clang 14 does not yet see the defaults.
struct LivePeople {
  std::uint64_t now = 0, tracks = 0;  ///< at the last scan; different ones since the start
  double nearest_m = -1;              ///< of those at the last scan; negative: there is nobody
};

/// What `cairn top` shows of a running core: one line of JSON a second, on a local socket. Both sides cut text at
/// kMaxText bytes and lists at kMaxItems.
struct LiveView {
  /// Times and counts of one task.
  struct Stage {
    std::string name;
    double p50_ms = 0, p99_ms = 0, p999_ms = 0, max_ms = 0;  ///< of the response, since the start of the run
    double deadline_ms = 0;                                  ///< of the response
    double budget_ms = 0;                                    ///< of the execution; 0: none declared
    std::uint64_t count = 0, overruns = 0;                   ///< ticks; those whose execution was above the budget
    std::uint64_t slips = 0, misses = 0;                     ///< releases passed; deadlines missed
    std::uint64_t dropped = 0, queued = 0, capacity = 0;     ///< of its input; capacity 0: it has no queue
  };
  /// One kind of event and how often it happened.
  struct Event {
    double t_s = 0;  ///< when it happened last
    std::string stage, what;
    std::uint64_t count = 0;
  };
  /// One peer: merged or not, and why.
  struct Peer {
    std::string name;
    bool merged = false;
    std::string state;        ///< why it is merged or not: PeerState as a word
    std::string reason;       ///< the same for people, with figures
    double heard_s_ago = -1;  ///< seconds since it was heard last; negative: never
    std::uint64_t tiles = 0, tx_bytes = 0, rx_bytes = 0;
    double clock_offset_s = 0;             ///< its clock minus this robot's; 0: not known
    bool deployment_contradicted = false;  ///< the deployments of the two do not fit to their maps
  };
  using People = LivePeople;
  std::string robot;
  double t_s = 0;  ///< robot time
  std::string mode, cause, shed;
  std::uint32_t epoch = 0;  ///< for a re-arm request
  std::uint64_t scans = 0;
  double rss_mb = 0;
  std::vector<std::string> faults;  ///< codes of what is wrong now
  std::vector<Stage> stages;
  std::vector<Event> events;     ///< the last one last
  std::vector<Peer> peers;       ///< of a robot that takes part in a team
  std::optional<People> people;  ///< none: nobody is followed

  static constexpr std::size_t kMaxText = 160, kMaxItems = 64;
  static constexpr std::size_t kMaxLine = 64 * 1024;
};

/// One line with its end, of at most kMaxLine bytes. Events that do not fit are left out, oldest first.
[[nodiscard]] std::string to_line(const LiveView& view);
/// The inverse, for bytes of any origin. Fields of another type or value count as missing. Errors: kLimit (longer than
/// kMaxLine), kMalformed (no JSON object).
[[nodiscard]] Result<LiveView> parse_line(std::string_view line);

}  // namespace cairn::app
