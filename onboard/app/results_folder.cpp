// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/results_folder.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <system_error>

#include "drivers/recording/formats/recording.hpp"
#include "onboard/app/people_figures.hpp"
#include "onboard/app/team/team_output.hpp"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

std::set<fs::path> names_in(const fs::path& folder) {
  std::set<fs::path> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) names.insert(entry.path().filename());
  return names;
}

/// What an earlier run left in the same folder, and this one has not.
void remove_stale(const fs::path& out, const std::set<fs::path>& fresh) {
  std::error_code ignored;
  if (fs::exists(out / recording::kIndexFile, ignored)) return;  // a recording's schedule.log is its own
  for (const fs::path& name : names_in(out)) {
    const bool not_in_every_run = name == kFailedRun || name == "schedule.log" ||
                                  std::ranges::find(kPeopleFiles, name.string()) != kPeopleFiles.end() ||
                                  std::ranges::find(kTeamFiles, name.string()) != kTeamFiles.end() ||
                                  name.string().starts_with("map-epoch-");
    if (not_in_every_run && !fresh.contains(name)) fs::remove_all(out / name, ignored);
  }
}

}  // namespace

Result<fs::path> put_in_place(const fs::path& out, UnfinishedFolder& unfinished, std::uint64_t scans) {
  const fs::path failed = out / kFailedRun;
  std::error_code error;
  if (scans == 0 && fs::exists(out / kResultMap, error)) {
    fs::remove_all(failed, error);
    if (const auto done = unfinished.become(failed); !done) return done.error();
    return failed;
  }
  const auto fresh = names_in(unfinished.path());
  if (const auto moved = unfinished.move_files_into(out, "report.json"); !moved) return moved.error();
  remove_stale(out, fresh);
  return out;
}

Error keep_incomplete(UnfinishedFolder& unfinished, Error error) {
  std::string names;
  for (const fs::path& name : names_in(unfinished.path()))
    if (std::error_code ignored; fs::is_regular_file(unfinished.path() / name, ignored))
      names += (names.empty() ? "" : ", ") + name.string();
  if (names.empty()) return error;
  error.detail += (error.detail.empty() ? "" : "; ") +
                  ("the results are not complete; what there is of them is kept in " + unfinished.path().string()) +
                  ": " + names;
  unfinished.leave();
  return error;
}

}  // namespace cairn::app
