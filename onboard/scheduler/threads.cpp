// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/threads.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <array>
#include <cstddef>

namespace cairn::scheduler {
namespace {

// Deeper than any task goes, and far below what a thread has (8 MiB).
constexpr std::size_t kStackBytes = 256 * 1024;
constexpr std::size_t kPageBytes = 4096;

/// Touches the stack, so that its pages are there before the first tick.
void prefault_stack() {
  std::array<std::byte, kStackBytes> stack;  // NOLINT(cppcoreguidelines-pro-type-member-init): only touched
  volatile std::byte* bytes = stack.data();
  for (std::size_t i = 0; i < kStackBytes; i += kPageBytes) bytes[i] = std::byte{};
}

void apply(const ThreadPlan& plan) {
  pthread_setname_np(pthread_self(), plan.name.substr(0, 15).c_str());
  if (plan.priority > 0) {
    const sched_param parameter{plan.priority};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  }
  // For Linux, 0 is the calling thread.
  if (plan.nice > 0) (void)setpriority(PRIO_PROCESS, 0, plan.nice);
  if (plan.core < 0 || plan.core >= CPU_SETSIZE) return;
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(static_cast<unsigned>(plan.core), &cores);
  pthread_setaffinity_np(pthread_self(), sizeof cores, &cores);
}

bool may_be_real_time(int priority) {
  bool allowed = false;
  const sched_param parameter{priority};
  std::thread([&] { allowed = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter) == 0; }).join();
  return allowed;
}

bool may_lock_memory() {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
  // Who has CAP_IPC_LOCK may lock beyond the limit: then a lock of more than it works.
  const std::size_t beyond = limit.rlim_cur + (std::size_t{1} << 20U);
  void* memory = ::mmap(nullptr, beyond, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) return false;
  const bool allowed = ::mlock2(memory, beyond, MLOCK_ONFAULT) == 0;
  ::munmap(memory, beyond);
  return allowed;
}

}  // namespace

void ThreadGroup::start(const ThreadPlan& plan, std::function<void()> work) {
  threads_.emplace_back([plan, work = std::move(work)] {
    become(plan);
    work();
  });
}

void ThreadGroup::join() {
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void become(const ThreadPlan& plan) {
  apply(plan);
  prefault_stack();
}

std::vector<std::string> probe_privileges(int highest_priority) {
  std::vector<std::string> missing;
  if (highest_priority > 0 && !may_be_real_time(highest_priority))
    missing.emplace_back("real-time priority (SCHED_FIFO): set LimitRTPRIO=99 in the unit, or rtprio in limits.conf");
  if (!may_lock_memory())
    missing.emplace_back("locked memory: set LimitMEMLOCK=infinity in the unit, or memlock in limits.conf");
  return missing;
}

bool may_run_on(int core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  return core >= 0 && core < CPU_SETSIZE && sched_getaffinity(0, sizeof cores, &cores) == 0 &&
         CPU_ISSET(static_cast<unsigned>(core), &cores);
}

bool lock_memory() { return may_lock_memory() && ::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0; }

ThreadUsage thread_usage() {
  rusage usage{};
  if (getrusage(RUSAGE_THREAD, &usage) != 0) return {};
  return {static_cast<std::uint64_t>(usage.ru_majflt), static_cast<std::uint64_t>(usage.ru_minflt),
          static_cast<std::uint64_t>(usage.ru_nivcsw)};
}

}  // namespace cairn::scheduler
