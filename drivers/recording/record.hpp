// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "drivers/recording/recording_writer.hpp"
#include "hal/clock.hpp"
#include "hal/ports.hpp"
#include "hal/result.hpp"

namespace cairn::recording {

/// When a recording ends, and who is told about its progress.
struct RecordOptions {
  std::optional<Duration> length{};           ///< none: until `stop` is true or the source ends
  std::function<bool()> stop{};               ///< asked between packets; none: never
  std::function<void(Duration)> on_second{};  ///< called about once a second with the time since the start
};

/// How a recording went.
struct RecordReport {
  Duration length{};
  std::uint64_t source_errors = 0;  ///< errors of the source; recording went on
  std::string first_error;
};

/// Writes every packet of `source` unchanged and flushes about once a second. At the end, packets that still wait in
/// the source are written too. An error of the writer (a full disk) ends the recording and is returned; what was
/// written before is kept. The writer is closed in any case.
[[nodiscard]] Result<RecordReport> record(Source& source, const Clock& clock, RecordingWriter& writer,
                                          const RecordOptions& options);

}  // namespace cairn::recording
