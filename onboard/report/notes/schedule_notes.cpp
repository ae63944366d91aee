// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "onboard/report/notes/note_list.hpp"

namespace cairn::report {
namespace {

constexpr const char* kMachine = "`cairn doctor` checks the machine's real-time rights; let nothing else run on it";

void note_stages(NoteList& notes, const Monitor& monitor) {
  for (const StageStats& s : monitor.stages()) {
    if (s.overruns == 0) continue;
    std::string text = fmt::format("Stage {} went over its budget of {} ms in {} of {} runs; the longest took {} ms.",
                                   s.name, plain(to_milliseconds(s.budget)), s.overruns.get(), s.wall.count(),
                                   plain(to_milliseconds(s.wall.max())));
    const char* remedy = "docs/tuning-budgets.md says how to make it faster";
    over_budget(s) ? notes.error(std::move(text), remedy) : notes.warning(std::move(text), remedy);
  }
}

void note_mode(NoteList& notes, const RunReport& report) {
  if (report.mode.empty() || report.mode == "normal") return;
  const std::string cause = report.mode_cause.empty() ? "" : ": " + report.mode_cause;
  notes.warning(fmt::format("The run ended in mode {}{}.", report.mode, cause),
                "docs/robot-setup.md explains modes and faults");
}

void note_shed(NoteList& notes, const RunReport& report) {
  std::uint64_t shed = 0;
  for (std::size_t level = 1; level < report.shed.size(); ++level) shed += report.shed[level].second;
  if (shed > 0)
    notes.warning(fmt::format("{} scans were mapped while work was shed: the map is sparser there.", shed), kMachine);
}

}  // namespace

void note_schedule(NoteList& notes, const RunReport& report) {
  if (report.ticks.missed.value_or(0) > 0)
    notes.error(fmt::format("{} of {} ticks of the safety task were missed.", *report.ticks.missed,
                            report.ticks.count + *report.ticks.missed),
                kMachine);
  if (report.monitor != nullptr) note_stages(notes, *report.monitor);
  for (const TaskFigures& task : report.tasks)
    if (task.stats.demotions > 0)
      notes.error(fmt::format("Task {} kept overrunning its hard budget and was demoted {} times.", task.spec.name,
                              task.stats.demotions.get()),
                  "docs/tuning-budgets.md says how to make it faster");
  if (!report.lost_schedule.empty())
    notes.warning(fmt::format("A replay cannot repeat this run to the bit. {}", report.lost_schedule),
                  "free space on that disk before the next run");
  note_mode(notes, report);
  note_shed(notes, report);
  if (report.control_thread_allocations.value_or(0) > 0)
    notes.warning(
        fmt::format("{} allocations on the control thread after the warm-up.", *report.control_thread_allocations),
        "a fault in the program: please report it");
}

}  // namespace cairn::report
