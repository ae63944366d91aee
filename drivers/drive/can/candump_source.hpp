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
    kSinceStart,  ///< each is UTC, or the time since the first frame (-tz)
    kSinceLast,   ///< each is the time since the last frame (-td)
  };
  static constexpr Duration kUnstamped = std::chrono::milliseconds(1);  ///< made-up distance of lines without stamps

  explicit CandumpTime(Stamps stamps) : stamps_(stamps) {}
  /// The time of the next line. A line without a stamp comes kUnstamped after the one before.
  Time place(std::optional<Time> stamp);

 private:
  Stamps stamps_;
  Time last_{};
};

/// Replays candump's text, in any of its forms, as fast as it is called. Packet::arrival is the stamp in the file.
class CandumpSource final : public Source {
 public:
  /// How a file is read.
  struct Options {
    SourceId source{};
    std::string interface;                      ///< only frames of this interface are delivered; empty: all
    std::optional<CandumpTime::Stamps> stamps;  ///< null: found out from the first kProbed frames
  };
  /// What happened to the lines of the file.
  struct Counters {
    std::uint64_t lines = 0, delivered = 0, filtered = 0, malformed = 0;
  };
  static constexpr int kProbed = 200;
  static constexpr int kMaxSkipped = 4096;

  /// Errors: kNotFound, kIo.
  static Result<std::unique_ptr<CandumpSource>> open(const std::filesystem::path& path, const Options& options);

  /// Never waits. An Error names file, line and column; go on calling. Returns kTimeout after kMaxSkipped lines that
  /// are not wanted.
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
