// SPDX-License-Identifier: Apache-2.0
#include "hal/workers.hpp"

namespace cairn {

Workers::Workers(unsigned threads, const std::function<void(unsigned)>& prepare) {
  for (unsigned i = 1; i < threads; ++i)
    pool_.emplace_back([this, prepare, i] {
      if (prepare) prepare(i);
      loop();
    });
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  wake_.notify_all();
  for (std::thread& t : pool_) t.join();
}

void Workers::run(std::size_t chunks, Call call, void* work) {
  if (pool_.empty() || chunks < 2) {
    for (std::size_t i = 0; i < chunks; ++i) call(work, i);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    call_ = call;
    work_ = work;
    chunks_ = chunks;
    next_.store(0, std::memory_order_relaxed);
    open_ = true;
    ++generation_;
  }
  wake_.notify_all();
  work_off();
  std::unique_lock lock(mutex_);
  // A thread that the machine has not woken by now is not waited for: under load that could take longer than the job.
  open_ = false;
  done_.wait(lock, [this] { return busy_ == 0; });
}

void Workers::work_off() {
  for (std::size_t i = next_.fetch_add(1); i < chunks_; i = next_.fetch_add(1)) call_(work_, i);
}

void Workers::loop() {
  std::size_t seen = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [&] { return quit_ || generation_ != seen; });
    if (quit_) return;
    seen = generation_;
    if (!open_) continue;
    ++busy_;
    lock.unlock();
    work_off();
    lock.lock();
    if (--busy_ == 0) done_.notify_one();
  }
}

}  // namespace cairn
