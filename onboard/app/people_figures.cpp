// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/people_figures.hpp"

#include <numbers>
#include <optional>

#include "hal/files/file.hpp"

namespace cairn::app {

void add_people(const RobotTasks& tasks, report::RunReport& report) {
  if (!tasks.robot.follows_people()) return;
  report::PeopleStats& people = report.people.emplace();
  people.tracks = tasks.mapping.people_log().tracks();
  people.apart = tasks.mapping.box_joiner().apart();
  const PeopleLog& log = tasks.mapping.people_log();
  people.most_at_once = log.most_at_once();
  if (log.most_at_once() > 0) people.nearest_m = static_cast<double>(log.nearest());
  people.paths = log.paths(report::PeopleStats::kMostPaths);
  for (const DetectionTask& task : tasks.detections) {
    const DetectionTask::Figures& looked = task.figures();
    const bool thermal = task.eye() == people::Eye::kThermal;
    const auto offset = tasks.robot.eye_offset(task.eye());
    (thermal ? people.thermal : people.visible) =
        report::DetectorStats{.images = looked.images,
                              .detections = looked.people,
                              .passed = looked.passed,
                              .shed = looked.shed,
                              .refused = looked.refused + looked.unknown,
                              .correcting = looked.correcting,
                              .offset_deg = offset ? std::optional(*offset * 180 / std::numbers::pi) : std::nullopt};
  }
}

Result<std::vector<std::filesystem::path>> write_people(const RobotTasks& tasks, const people::PeopleConfig& config,
                                                        Duration shift, const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (!tasks.robot.follows_people()) return files;
  const auto write = [&](const char* name, const std::string& text) {
    files.push_back(folder / name);
    return write_file_atomic(files.back(), text);
  };
  if (const auto r = write(kPeopleFiles[0], tasks.mapping.people_log().to_csv(shift)); !r) return r.error();
  if (!config.log_answers) return files;
  if (const auto r = write(kPeopleFiles[1], tasks.mapping.box_joiner().answers().to_csv(shift)); !r) return r.error();
  return files;
}

}  // namespace cairn::app
