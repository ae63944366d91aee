// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "onboard/scheduler/task_spec.hpp"

namespace cairn::scheduler {

/// How a thread is to run. What the system does not allow is left out; see probe_privileges().
struct ThreadPlan {
  std::string name;  ///< as ps and top show it; 15 characters are kept
  int priority = 0;  ///< SCHED_FIFO 1…99; 0: SCHED_OTHER
  int nice = 0;      ///< of SCHED_OTHER; 0: as the process
  int core = -1;     ///< -1: any
};

/// The plan of the thread that runs a task.
[[nodiscard]] inline ThreadPlan plan_of(const TaskSpec& spec) {
  return {.name = spec.name, .priority = spec.priority, .nice = spec.nice, .core = spec.core};
}

/// Threads that are joined together. The onboard program starts its own threads here and nowhere else; hal/workers
/// starts those that compute.
class ThreadGroup {
 public:
  ThreadGroup() = default;
  ThreadGroup(const ThreadGroup&) = delete;
  ThreadGroup& operator=(const ThreadGroup&) = delete;
  ~ThreadGroup() { join(); }

  void start(const ThreadPlan& plan, std::function<void()> work);
  /// Returns when the work of every thread has ended.
  void join();

 private:
  std::vector<std::thread> threads_;
};

/// Gives the calling thread name, priority and core, and touches its stack.
void become(const ThreadPlan& plan);

/// What real-time operation needs and this process lacks, each with its remedy. Empty: nothing is missing.
[[nodiscard]] std::vector<std::string> probe_privileges(int highest_priority);

/// Whether this process may bind a thread to the core: taskset and cpusets of containers withhold some.
[[nodiscard]] bool may_run_on(int core);

/// Keeps the process's memory from being paged out, as it is touched (mlockall, on fault). False: not allowed.
bool lock_memory();

/// Page faults and switches of the calling thread since it began.
struct ThreadUsage {
  std::uint64_t major_faults = 0, minor_faults = 0, involuntary_switches = 0;
};
[[nodiscard]] ThreadUsage thread_usage();

}  // namespace cairn::scheduler
