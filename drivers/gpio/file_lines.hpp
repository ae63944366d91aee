// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/gpio/gpio_lines.hpp"

namespace cairn::gpio {

/// How the name of a chip begins that is a folder: file:PATH.
inline constexpr std::string_view kFileChip = "file:";
[[nodiscard]] inline bool is_file_chip(std::string_view chip) { return chip.starts_with(kFileChip); }

/// Lines without a chip, for a robot that another program plays: each line is a file in a folder, has the line's name
/// and holds 1 (high) or 0 (low). An empty file is a line that is not active: a shell empties a file before it writes.
/// The files are read at every call, so keep them in memory, such as in /run. An edge is seen when the level differs
/// from that of the call before; its stamp is the time of that call. Two edges between two calls are not seen.
class FileLines final : public GpioLines {
 public:
  static constexpr Duration kGlance = std::chrono::milliseconds(1);  ///< between two looks while next() waits

  /// `clock` must outlive the lines. Errors: kInvalidConfig (no folder named), kNotFound (no file for an input), kIo,
  /// each with the remedy.
  static Result<std::unique_ptr<FileLines>> open(const Config& config, SourceId source, const Clock& clock);

  Result<Poll> next(Packet& packet, Duration timeout) override;
  /// Also kMalformed: the file holds something else.
  Result<bool> level(Line line) override;
  Result<void> set(Line line, bool level) override;

 private:
  struct File {
    std::string path;  ///< empty: not configured
    bool output = false, active_low = false;
    std::optional<bool> level;  ///< logical, when it was last looked at
  };
  FileLines(const Config& config, SourceId source, const Clock& clock);
  /// Whether an input has changed; the packet then tells of it.
  bool look(Packet& packet);

  std::array<File, kLines> files_;
  const Clock& clock_;
};

}  // namespace cairn::gpio
