// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/task_spec.hpp"

#include <array>
#include <cstdio>
#include <string_view>

namespace cairn::scheduler {
namespace {

// Not a promise that 0.7 of a core is 70.0000001 % of it.
constexpr double kRounding = 1e-9;

constexpr std::string_view kRemedy = "lower soft_ms, busy_hz or rate_hz of the largest share, or use more cores\n";

template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 160> line{};
  const int n = std::snprintf(line.data(), line.size(), pattern, values...);
  return {line.data(), static_cast<std::size_t>(n)};
}

/// Whose promises are added up.
enum class Counted : bool { kStrong, kAll };

/// Of `core`; of all unbound tasks for -1.
double promised(std::span<const TaskSpec> tasks, int core, Counted counted = Counted::kAll) {
  double sum = 0;
  for (const TaskSpec& t : tasks)
    if (t.core == core && (counted == Counted::kAll || t.nice == 0)) sum += t.utilisation();
  return sum;
}

std::string faults_of(const TaskSpec& t, int cores) {
  std::string faults;
  const auto add = [&](const std::string& what) { faults += t.name + ": " + what + "\n"; };
  if (t.core >= cores) add(format("core %d, but this machine has %d, counted from 0; -1 is any", t.core, cores));
  if (t.hard_ms > 0 && t.soft_ms > t.hard_ms) add("soft_ms is above hard_ms");
  if (t.hard() > t.deadline()) add("hard_ms is above the deadline");
  return faults;
}

std::string overloads(std::span<const TaskSpec> tasks, int cores, Counted counted) {
  const double most = counted == Counted::kAll ? kMaxWithWeak : kMaxUtilisation;
  const char* whose = counted == Counted::kAll ? " with weak tasks" : "";
  std::string faults;
  double all = 0;
  for (int core = 0; core < cores; ++core) {
    const double share = promised(tasks, core, counted);
    all += share;
    if (share > most + kRounding)
      faults +=
          format("core %d%s: %.1f %% of it are planned, and %.0f %% may be\n", core, whose, 100 * share, 100 * most);
  }
  all += promised(tasks, -1, counted);
  if (all > most * cores + kRounding)
    faults += format("all %d cores%s: %.1f %% of one are planned, and %.0f %% may be, %.0f %% of each\n", cores, whose,
                     100 * all, 100 * most * cores, 100 * most);
  if (!faults.empty()) faults += kRemedy;
  return faults;
}

}  // namespace

void declare(config::Section& s, TaskSpec& t) {
  s.number("rate_hz", t.rate_hz, {0.1, 2000}, "Hz", "releases per second");
  s.number("phase_ms", t.phase_ms, {0, 10000}, "ms", "of the first release");
  s.number("deadline_ms", t.deadline_ms, {0, 10000}, "ms", "from release to the end of the tick; 0: the period");
  s.number("soft_ms", t.soft_ms, {0, 10000}, "ms", "planned execution time; more is counted; 0: none");
  s.number("hard_ms", t.hard_ms, {0, 10000}, "ms", "execution time at which a tick has failed; 0: none");
  s.number("busy_hz", t.busy_hz, {0, 2000}, "Hz", "releases per second that find work; 0: all of them");
  s.integer("priority", t.priority, {0, 99}, "", "SCHED_FIFO priority; 0: SCHED_OTHER");
  s.integer("nice", t.nice, {0, 19}, "", "nice value: a higher value means a lower priority");
  s.integer("core", t.core, {-1, 1023}, "", "the CPU it is bound to; -1: any");
}

std::string to_table(std::span<const TaskSpec> tasks, int cores) {
  std::string table = "task           rate Hz  busy Hz  soft ms  hard ms  deadline ms  priority  core    share\n";
  for (const TaskSpec& t : tasks)
    table += format("%-13s %8.1f %8.1f %8.2f %8.2f %12.1f %9d %5d %7.1f%%\n", t.name.c_str(), t.rate_hz,
                    t.busy_hz > 0 ? t.busy_hz : t.rate_hz, t.soft_ms, t.hard_ms, to_milliseconds(t.deadline()),
                    t.priority, t.core, 100 * t.utilisation());
  for (int core = 0; core < cores; ++core)
    if (const double share = promised(tasks, core); share > 0)
      table += format("core %-3d %75.1f%%\n", core, 100 * share);
  table += format("unbound  %75.1f%%\n", 100 * promised(tasks, -1));
  return table;
}

Result<void> validate(std::span<const TaskSpec> tasks, int cores) {
  std::string faults;
  for (const TaskSpec& t : tasks) faults += faults_of(t, cores);
  faults += overloads(tasks, cores, Counted::kStrong);
  if (faults.empty()) faults = overloads(tasks, cores, Counted::kAll);
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig,
               "the schedule does not fit this machine",
               "schedule",
               {},
               "\n" + faults + to_table(tasks, cores)};
}

}  // namespace cairn::scheduler
