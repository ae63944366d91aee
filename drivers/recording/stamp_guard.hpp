// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/ports.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::recording {

/// Finds single packets of a dense source (LiDAR, bus, sweeps) whose stamps are absurd: more than kFar away from the
/// packet before, while the packets behind do not follow. One such packet would stretch a run over years. A long pause
/// is not absurd, because several packets come after it.
class StampGuard {
 public:
  static constexpr Duration kFar = std::chrono::hours(1);
  static constexpr std::size_t kAhead = 4;  ///< packets behind that have a say

  /// What was found so far.
  struct Found {
    std::uint64_t count = 0;
    std::uint64_t first_packet = 0;             ///< in the order of the file, from 0
    std::optional<std::uint64_t> first_offset;  ///< of its record in the file, if known
    Duration first_distance{};                  ///< from the packet before it, or behind it if it is the first
  };
  /// About the oldest stamp that was not judged yet.
  struct Verdict {
    Time stamp{};
    bool absurd = false;
  };

  /// The next stamp in the order of the file; not beyond ±2⁶¹ ns. `offset`: of its record.
  void push(Time stamp, std::optional<std::uint64_t> offset = std::nullopt);
  /// No stamp will follow.
  void end() { ended_ = true; }
  /// None: it needs more stamps first.
  [[nodiscard]] std::optional<Verdict> pop();

  [[nodiscard]] const Found& found() const { return found_; }
  /// One error for all of them, with count, first place and remedy. `what_now`: "they are set aside". Null: none found.
  [[nodiscard]] std::optional<Error> to_error(const std::string& file, const char* what_now) const;

 private:
  struct Stamp {
    Time time{};
    std::optional<std::uint64_t> offset;
  };
  [[nodiscard]] bool is_absurd(Time stamp) const;

  std::deque<Stamp> open_;
  std::optional<Time> last_;  // that is not absurd
  std::uint64_t judged_ = 0;
  bool ended_ = false;
  Found found_;
};

/// A recorded source without its packets of absurd stamps; the others are numbered without them. At its end, one Error
/// names them. Reads kAhead packets ahead.
class GuardedSource final : public Source {
 public:
  /// Where the record of the packet that was handed out last begins in the file; it may be empty.
  using Offset = std::function<std::optional<std::uint64_t>()>;
  GuardedSource(std::unique_ptr<Source> recorded, std::string file, Offset offset = {});

  /// Errors and time-outs of the source are handed on at once.
  Result<Poll> next(Packet& packet, Duration timeout) override;

 private:
  std::unique_ptr<Source> recorded_;
  std::string file_;
  Offset offset_;
  StampGuard guard_;
  std::vector<Packet> ring_;  // packets that are not judged yet, oldest at first_
  std::size_t first_ = 0, held_ = 0;
  bool ended_ = false, told_ = false;
};

}  // namespace cairn::recording
