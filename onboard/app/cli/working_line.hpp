// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdio>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "hal/time.hpp"
#include "hal/workers.hpp"

namespace cairn::app {

/// One line on a terminal that says what is being done and for how long: "matching, 12 s".
class WorkingLine {
 public:
  /// `period`: from one line to the next, which counts as a second.
  WorkingLine(std::string what, std::FILE* out, Duration period) : what_(std::move(what)), out_(out), period_(period) {}

  /// Writes a line after each period until end() is called, and wipes it then.
  void show();
  void end();

 private:
  std::string what_;
  std::FILE* out_;
  Duration period_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool over_ = false;
};

/// Stderr where it is a terminal, otherwise null.
[[nodiscard]] std::FILE* terminal();

/// Returns what `work` returns. Meanwhile a terminal shows a WorkingLine; null: none. For work that cannot say how far
/// it is. With a line, the work may run on another thread.
template <class Work>
[[nodiscard]] std::invoke_result_t<Work> while_working(std::string what, Work&& work, std::FILE* out = terminal(),
                                                       Duration period = std::chrono::seconds(1)) {
  if (out == nullptr) return work();
  std::optional<std::invoke_result_t<Work>> result;
  WorkingLine line(std::move(what), out, period);
  Workers two(2);
  two.for_each(2, [&](std::size_t side) {
    if (side == 1) return line.show();
    result.emplace(work());
    line.end();
  });
  return *std::move(result);
}

}  // namespace cairn::app
