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

struct RecordOptions {
  std::optional<Duration> length{};           ///< none: until `stop` says so or the source ends
  std::function<bool()> stop{};               ///< asked between packets; none: never
  std::function<void(Duration)> on_second{};  ///< called about once a second with the time since the start
};

struct RecordReport {
  Duration length{};
  std::uint64_t source_errors = 0;  ///< the source said so; recording went on
  std::string first_error;
};

/// Writes every packet of `source` as it is, flushing about once a second, until the end; what has come by then and
/// still waits in the source is written, too. An error of the writer (a full disk) ends the recording and is handed on;
/// what was written before it is kept. The writer is closed in any case.
[[nodiscard]] Result<RecordReport> record(Source& source, const Clock& clock, RecordingWriter& writer,
                                          const RecordOptions& options);

}  // namespace cairn::recording
