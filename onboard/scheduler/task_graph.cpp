// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/task_graph.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace cairn::scheduler {
namespace {

/// A number, or a dash where none is declared.
std::string or_dash(const char* pattern, double value, bool declared) {
  if (!declared) return "-";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), pattern, value);
  return text.data();
}

std::string row_of(const ScheduledTask& task) {
  const TaskSpec& s = task.spec;
  std::array<char, 200> line{};
  std::snprintf(line.data(), line.size(), "%-13s %8g  %8s  %4s  %7s  %7s  %11g  %s\n", s.name.c_str(), s.rate_hz,
                or_dash("%g", s.priority, s.priority > 0).c_str(), or_dash("%g", s.core, s.core >= 0).c_str(),
                or_dash("%g", s.soft_ms, s.soft_ms > 0).c_str(), or_dash("%g", s.hard_ms, s.hard_ms > 0).c_str(),
                to_milliseconds(s.deadline()), std::string(to_string(task.role)).c_str());
  return line.data();
}

template <class Tasks>
auto& find(Tasks& tasks, const Task& task) {
  const auto found = std::ranges::find_if(tasks, [&](const ScheduledTask& t) { return &t.task == &task; });
  if (found == tasks.end()) std::abort();
  return *found;
}

}  // namespace

std::string_view to_string(TaskRole role) {
  switch (role) {
    case TaskRole::kStage:
    case TaskRole::kNewStage:
      return "stage";
    case TaskRole::kInput:
      return "input";
    case TaskRole::kLiveOnly:
      return "live only";
  }
  return "";
}

ScheduledTask& TaskGraph::add(TaskSpec spec, Task& task, TaskRole role) {
  return tasks_.emplace_back(std::move(spec), task, role);
}

const ScheduledTask& TaskGraph::scheduled(const Task& task) const { return find(tasks_, task); }
ScheduledTask& TaskGraph::scheduled(const Task& task) { return find(tasks_, task); }

std::string TaskGraph::name_of(const Port& port) const {
  return scheduled(port.task()).spec.name + "." + std::string(port.name());
}

std::vector<TaskGraph::Connection> TaskGraph::connections() const {
  std::vector<Connection> all;
  for (const Link& link : links_) all.push_back({name_of(*link.from), name_of(*link.to), link.channel->options()});
  return all;
}

std::string TaskGraph::to_text() const {
  std::string text = "task           rate Hz  priority  core  soft ms  hard ms  deadline ms  role\n";
  for (const ScheduledTask& task : tasks_) text += row_of(task);
  text += "\nfrom                 to                   capacity   lag ms\n";
  for (const Connection& c : connections()) {
    std::array<char, 200> line{};
    std::snprintf(line.data(), line.size(), "%-20s %-20s %8zu %8g\n", c.from.c_str(), c.to.c_str(), c.options.capacity,
                  to_milliseconds(c.options.lag));
    text += line.data();
  }
  return text;
}

}  // namespace cairn::scheduler
