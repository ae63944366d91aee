// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "onboard/scheduler/scheduled_task.hpp"

namespace cairn::scheduler {

[[nodiscard]] std::string_view to_string(TaskRole role);

/// The tasks of one robot and the channels between them. Everything is added before a run.
class TaskGraph {
 public:
  TaskGraph() = default;
  TaskGraph(const TaskGraph&) = delete;
  TaskGraph& operator=(const TaskGraph&) = delete;
  ~TaskGraph() = default;

  /// Tasks that are released together run in the order in which they are added: producers before consumers. `task`
  /// must outlive the graph. The reference stays valid as long as the graph.
  ScheduledTask& add(TaskSpec spec, Task& task, TaskRole role = TaskRole::kStage);

  /// Joins two tasks that were added before. Aborts when one of them was not, or when a port has a channel already.
  template <class T>
  void connect(OutputPort<T>& from, InputPort<T>& to, const ChannelOptions& options) {
    ScheduledTask &producer = scheduled(from.task()), &consumer = scheduled(to.task());
    if (from.connected() || to.channel() != nullptr) std::abort();
    auto channel = std::make_unique<Channel<T>>(options, producer.progress, consumer.progress);
    from.connect(*channel);
    to.connect(*channel);
    consumer.inputs.push_back(&to);
    links_.push_back({&from, &to, std::move(channel)});
  }

  /// The place of a task that was added. Aborts when it was not.
  [[nodiscard]] const ScheduledTask& scheduled(const Task& task) const;
  [[nodiscard]] ScheduledTask& scheduled(const Task& task);
  [[nodiscard]] const std::deque<ScheduledTask>& tasks() const { return tasks_; }
  [[nodiscard]] std::deque<ScheduledTask>& tasks() { return tasks_; }

  /// A channel: its ports as "task.port".
  struct Connection {
    std::string from, to;
    ChannelOptions options;
  };
  /// In the order in which they were made.
  [[nodiscard]] std::vector<Connection> connections() const;
  /// Tasks with rate, priority and budget, then the channels between them: two tables in plain text.
  [[nodiscard]] std::string to_text() const;

 private:
  struct Link {
    const Port* from;
    const Port* to;
    std::unique_ptr<ChannelBase> channel;
  };
  [[nodiscard]] std::string name_of(const Port& port) const;

  std::deque<ScheduledTask> tasks_;
  std::vector<Link> links_;
};

}  // namespace cairn::scheduler
