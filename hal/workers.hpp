// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace cairn {

/// Runs the numbered chunks of one job on a fixed set of threads. Any thread may run any chunk. For the same result
/// with any number of threads:
///   - the number of chunks must not depend on the number of threads
///   - each chunk must write to a place of its own
///   - the caller must reduce in the order of the chunks
class Workers {
 public:
  /// `threads` includes the calling thread: 1 starts none. `prepare` is called first on each started thread, with its
  /// number from 1. It may give the thread a name or a priority.
  explicit Workers(unsigned threads, const std::function<void(unsigned)>& prepare = {});
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  [[nodiscard]] unsigned threads() const { return static_cast<unsigned>(pool_.size()) + 1; }

  /// Calls work(i) for every i < chunks and returns when all are done. Never allocates. Only one caller at a time.
  /// `work` must not throw and must not call for_each() of the same Workers.
  template <class Work>
  void for_each(std::size_t chunks, Work&& work) {
    using Plain = std::remove_reference_t<Work>;
    run(
        chunks, [](void* w, std::size_t i) { (*static_cast<Plain*>(w))(i); }, &work);
  }

 private:
  using Call = void (*)(void*, std::size_t);
  void run(std::size_t chunks, Call call, void* work);
  void work_off();
  void loop();

  std::mutex mutex_;
  std::condition_variable wake_, done_;
  Call call_ = nullptr;
  void* work_ = nullptr;
  std::size_t chunks_ = 0;
  std::atomic<std::size_t> next_{0};
  std::size_t busy_ = 0;        // threads that have begun with the current job and not yet ended
  std::size_t generation_ = 0;  // counts jobs, so that a thread takes each one once
  bool open_ = false;           // whether a thread that wakes up may still begin with the current job
  bool quit_ = false;
  std::vector<std::thread> pool_;
};

}  // namespace cairn
