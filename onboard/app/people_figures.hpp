// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "onboard/app/tasks/robot_tasks.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::app {

/// Adds the figures of a run that followed people.
void add_people(const RobotTasks& tasks, report::RunReport& report);

/// The files of such a run. answers.csv is one where the profile asks for it.
inline constexpr std::array kPeopleFiles{"people.csv", "answers.csv"};
/// Writes them into `folder` and returns which there are. `shift`: what was added to the recording's time. Error kIo.
[[nodiscard]] Result<std::vector<std::filesystem::path>> write_people(const RobotTasks& tasks,
                                                                      const people::PeopleConfig& config,
                                                                      Duration shift,
                                                                      const std::filesystem::path& folder);

}  // namespace cairn::app
