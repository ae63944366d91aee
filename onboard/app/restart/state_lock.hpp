// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/result.hpp"

namespace cairn::app {

/// Keeps other cores out of a state folder as long as it lives: two of them would overwrite each other's map. The
/// system lets go of it when the process ends, however that happens.
class StateLock {
 public:
  /// Makes `folder` if it is not there. Errors: kLimit when another process holds the lock; kIo when the folder cannot
  /// be used.
  [[nodiscard]] static Result<StateLock> take(const std::filesystem::path& folder);

  StateLock(StateLock&& other) noexcept;
  StateLock(const StateLock&) = delete;
  StateLock& operator=(const StateLock&) = delete;
  StateLock& operator=(StateLock&&) = delete;
  ~StateLock();

 private:
  explicit StateLock(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace cairn::app
