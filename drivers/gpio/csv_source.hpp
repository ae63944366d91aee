// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "drivers/gpio/line_event.hpp"
#include "hal/files/line_file.hpp"
#include "hal/ports.hpp"

namespace cairn::gpio {

/// Replays gpio.csv as edges, as fast as it is called. Packet::arrival is the stamp in the file.
class CsvSource final : public Source {
 public:
  /// What happened to the rows of the file.
  struct Counters {
    std::uint64_t delivered = 0, malformed = 0;
    std::uint64_t unknown = 0;  ///< rows of lines with other names than name_of() has
  };
  static constexpr int kMaxSkipped = 4096;

  /// Errors: kNotFound, kIo.
  static Result<std::unique_ptr<CsvSource>> open(const std::filesystem::path& path, SourceId source);
  /// Never waits. An Error names file, line and column; go on calling. Returns kTimeout after kMaxSkipped rows that are
  /// not wanted.
  Result<Poll> next(Packet& packet, Duration timeout) override;
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  CsvSource(LineFile file, SourceId source) : file_(std::move(file)), source_(source) {}

  LineFile file_;
  SourceId source_;
  Counters counters_;
  bool ended_ = false;
};

}  // namespace cairn::gpio
