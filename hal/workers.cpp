// SPDX-License-Identifier: Apache-2.0
#include "hal/workers.hpp"

namespace cairn {

Workers::Workers(unsigned threads) {
  for (unsigned i = 1; i < threads; ++i) pool_.emplace_back([this] { loop(); });
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
    busy_ = pool_.size();
    ++generation_;
  }
  wake_.notify_all();
  work_off();
  std::unique_lock lock(mutex_);
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
    lock.unlock();
    work_off();
    lock.lock();
    if (--busy_ == 0) done_.notify_one();
  }
}

}  // namespace cairn
