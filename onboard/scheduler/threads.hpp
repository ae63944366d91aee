// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace cairn::scheduler {

/// How a thread is to run. Whatever the system does not allow is left out; see probe_privileges().
struct ThreadPlan {
  std::string name;  ///< as ps and top show it; 15 characters are kept
  int priority = 0;  ///< SCHED_FIFO 1…99; 0: SCHED_OTHER
  int core = -1;     ///< -1: any
};

/// The only place where the onboard program starts threads of its own (beside hal/workers, which compute).
[[nodiscard]] std::thread start_thread(const ThreadPlan& plan, std::function<void()> work);

/// Gives the calling thread name, priority and core, and touches its stack.
void become(const ThreadPlan& plan);

/// What real-time operation needs and this process has not got, each with its remedy; empty: all is there.
[[nodiscard]] std::vector<std::string> probe_privileges(int highest_priority);

/// Keeps the process's memory from being paged out, as it is touched (mlockall, on fault). False: not allowed.
bool lock_memory();

/// Of the calling thread, since it began.
struct ThreadUsage {
  std::uint64_t major_faults = 0, minor_faults = 0, involuntary_switches = 0;
};
[[nodiscard]] ThreadUsage thread_usage();

}  // namespace cairn::scheduler
