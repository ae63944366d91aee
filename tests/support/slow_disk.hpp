// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "hal/files/file_calls.hpp"

namespace cairn::support {

/// A disk on which every sync takes as long as the test likes.
class SlowDisk final : public FileCalls {
 public:
  int fsync(int fd) override {
    busy_ = true;
    while (slow_.load()) slow_.wait(true);
    busy_ = false;
    return FileCalls::fsync(fd);
  }
  void become_slow() { slow_ = true; }
  void heal() {
    slow_ = false;
    slow_.notify_all();
  }
  /// Someone waits for it.
  [[nodiscard]] bool busy() const { return busy_; }

 private:
  std::atomic<bool> slow_{false}, busy_{false};
};

}  // namespace cairn::support
