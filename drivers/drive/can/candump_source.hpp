// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "drivers/drive/can/candump.hpp"
#include "hal/files/line_file.hpp"
#include "hal/ports.hpp"

namespace cairn::drive {

/// Puts the stamps of candump's lines on one time line.
class CandumpTime {
 public:
  enum class Stamps : std::uint8_t {
    kSinceStart,  ///< each stands for itself: UTC, or since the first frame (-tz)
    kSinceLast,   ///< each is the time since the last frame (-td)
  };
  static constexpr Duration kUnstamped = std::chrono::milliseconds(1);  ///< made-up distance of lines without stamps

  explicit CandumpTime(Stamps stamps) : stamps_(stamps) {}
  Time place(std::optional<Time> stamp);

 private:
  Stamps stamps_;
  Time last_{};
};

/// Replays candump's text, in any of its forms, as fast as it is asked for. Packet::arrival is the stamp as the file's
/// clock had it.
class CandumpSource final : public Source {
 public:
  struct Options {
    SourceId source{};
    std::string interface;                      ///< the only one to let through; empty: all
    std::optional<CandumpTime::Stamps> stamps;  ///< none: found out from the first kProbed frames
  };
  struct Counters {
    std::uint64_t lines = 0, delivered = 0, filtered = 0, malformed = 0;
  };
  static constexpr int kProbed = 200;
  static constexpr int kMaxSkipped = 4096;

  static Result<std::unique_ptr<CandumpSource>> open(const std::filesystem::path& path, const Options& options);

  /// An Error names file, line and column; go on calling. Returns kTimeout after kMaxSkipped lines that are not wanted;
  /// `timeout` itself is not used.
  Result<Poll> next(Packet& packet, Duration timeout) override;
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  CandumpSource(LineFile file, const Options& options, CandumpTime::Stamps stamps)
      : file_(std::move(file)), options_(options), time_(stamps) {}

  LineFile file_;
  Options options_;
  CandumpTime time_;
  Counters counters_;
  bool ended_ = false;
};

}  // namespace cairn::drive
