// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/peers/log_limiter.hpp"
#include "hal/clock.hpp"

namespace cairn::peer_link {

/// Takes over the log of Cyclone DDS while it lives, and writes it to stderr within LogLimiter's bounds. Cyclone itself
/// writes a line for each malformed packet. There is one log in a process, so there may be one object.
class DdsLog {
 public:
  /// Lines begin with `program`. `clock` must outlive it.
  DdsLog(const Clock& clock, std::string program);
  DdsLog(const DdsLog&) = delete;
  DdsLog& operator=(const DdsLog&) = delete;
  /// Gives the log back to Cyclone, after the last summary.
  ~DdsLog();

  /// Writes the summary of a period that is over; to be called about once a second.
  void settle();
  /// Writes the summary now: at the end, before Cyclone's threads are waited for.
  void sum_up();

 private:
  void write(std::string_view line);

  void print(const std::vector<std::string>& lines) const;

  const Clock& clock_;
  std::string program_;
  std::mutex mutex_;  // Cyclone's threads write
  LogLimiter limiter_;
};

}  // namespace cairn::peer_link
