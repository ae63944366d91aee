// SPDX-License-Identifier: Apache-2.0
#include "tools/team/figures/team_recordings.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "drivers/recording/recording_reader.hpp"

namespace cairn::team_run {
namespace {

namespace fs = std::filesystem;

bool is_recording(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / recording::kIndexFile, ignored);
}

/// The recordings that a folder stands for.
std::vector<fs::path> recordings_in(const fs::path& folder) {
  if (is_recording(folder)) return {folder};
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (is_recording(entry.path())) found.push_back(entry.path());
  std::ranges::sort(found);
  if (found.empty()) found.push_back(folder);  // whose opening says what is wrong
  return found;
}

Result<TeamRecording> survey(const fs::path& folder) {
  auto reader = recording::RecordingReader::open(folder);
  if (!reader) return at(folder.string(), reader.error());
  TeamRecording found{(*reader)->recording().robot, fs::absolute(folder), {}, 0};
  std::optional<Time> first;
  Packet packet;
  for (;;) {
    const auto poll = (*reader)->next(packet, {});
    if (!poll) return at(folder.string(), poll.error());
    if (*poll == Poll::kEnd) break;
    if (*poll != Poll::kPacket) continue;
    if (!first) first = packet.arrival;
    found.length = packet.arrival - *first;
    found.raw_bytes += packet.bytes.size();
  }
  return found;
}

}  // namespace

Result<std::vector<TeamRecording>> survey_recordings(const std::vector<fs::path>& folders) {
  std::vector<TeamRecording> all;
  std::set<std::string> names;
  for (const fs::path& folder : folders)
    for (const fs::path& dir : recordings_in(folder)) {
      auto one = survey(dir);
      if (!one) return one.error();
      if (!names.insert(one->name).second)
        return Error{Errc::kInvalidConfig, "another robot has this name", dir.string(), {}, one->name};
      all.push_back(*std::move(one));
    }
  if (all.size() < 2) return Error{Errc::kInvalidConfig, "a team has two robots at least", "--recordings"};
  return all;
}

}  // namespace cairn::team_run
