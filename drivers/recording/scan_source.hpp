// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/recording/formats/scan_file.hpp"
#include "hal/ports.hpp"

namespace cairn::recording {

/// Replays the sweeps of a data.csv, one packet each: arrival = stamp, channel = ScanLayout, sequence = place in the
/// index.
class ScanSource final : public Source {
 public:
  /// Reads `dir`/`index`. With a damaged index the entries before the damage are handed out, then the error once.
  [[nodiscard]] static Result<std::unique_ptr<ScanSource>> open(std::filesystem::path dir, const std::string& index);

  /// Never waits. A sweep that cannot be read is one error, and the next call goes on with the next sweep.
  Result<Poll> next(Packet& packet, Duration timeout) override;

  [[nodiscard]] const std::vector<ScanIndexEntry>& entries() const { return entries_; }

 private:
  explicit ScanSource(std::filesystem::path dir) : dir_(std::move(dir)) {}

  std::filesystem::path dir_;
  std::vector<ScanIndexEntry> entries_;
  std::optional<Error> damage_;
  std::size_t next_ = 0;
};

}  // namespace cairn::recording
