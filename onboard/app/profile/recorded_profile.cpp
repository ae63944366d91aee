// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/recorded_profile.hpp"

#include <algorithm>
#include <sstream>
#include <system_error>
#include <utility>

#include "drivers/recording/formats/recording.hpp"
#include "hal/files/file.hpp"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;
using recording::SourceEntry;

/// The entry of the LiDAR; null: the recording has none.
const SourceEntry* lidar_of(const recording::Recording& recording) {
  const SourceEntry* found = nullptr;
  for (const SourceEntry& entry : recording.sources)
    if (entry.kind == recording::kVelodyne || entry.kind == recording::kScans) found = &entry;
  return found;
}

/// How the LiDAR was mounted, and how it sent.
void take_recorded(const SourceEntry& entry, LidarProfile& lidar) {
  lidar.driver.data_port = entry.data_port;
  lidar.driver.position_port = entry.position_port;
  if (entry.kind == recording::kVelodyne && !entry.model.empty()) lidar.driver.model = entry.model;
  if (entry.base_sensor_xyz_rpy)
    lidar.base_xyz_rpy.assign(entry.base_sensor_xyz_rpy->begin(), entry.base_sensor_xyz_rpy->end());
}

std::string joined(const std::vector<std::string>& words) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), kMost); ++i) text += (i == 0 ? "" : ", ") + words[i];
  if (words.size() > kMost) text += " and " + std::to_string(words.size() - kMost) + " more";
  return text;
}

/// Puts back what the recording knows better than `given`, and says so.
void keep_what_is_recorded(const SourceEntry& entry, ChosenProfile& given) {
  LidarProfile& lidar = given.profile.lidar;
  const LidarProfile wanted = lidar;
  const std::vector<double> mount = lidar.base_xyz_rpy;
  take_recorded(entry, lidar);
  if (entry.kind == recording::kVelodyne) lidar.base_xyz_rpy = mount;
  std::vector<std::string> unused;
  if (wanted.driver.model != lidar.driver.model) unused.emplace_back("lidar.model");
  if (wanted.driver.data_port != lidar.driver.data_port) unused.emplace_back("lidar.data_port");
  if (wanted.driver.position_port != lidar.driver.position_port) unused.emplace_back("lidar.position_port");
  if (wanted.base_xyz_rpy != lidar.base_xyz_rpy) unused.emplace_back("lidar.T_base_lidar");
  if (!unused.empty())
    given.notes.push_back("the recording's values replace these settings of the profile: " + joined(unused));
}

/// The recording's own profile; `base` where it keeps none.
Result<ChosenProfile> own_profile(const fs::path& recording, const RobotProfile& base) {
  const fs::path file = recording / recording::kProfileFile;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return ChosenProfile{.profile = base, .file = {}, .notes = {}};
  auto profile = load_profile(file, base);
  if (profile) return ChosenProfile{.profile = std::move(*profile), .file = file, .notes = {}};
  Error error = profile.error();
  error.detail += "\nthis profile is the recording's own; name another with --config";
  return error;
}

void note_differences(const ChosenProfile& own, ChosenProfile& given) {
  RobotProfile a = own.profile, b = given.profile;
  b.name = a.name;        // the recording's goes before both
  b.threads = a.threads;  // changes no result
  b.team.id = a.team.id;  // these two are about who takes part now
  b.team.socket = a.team.socket;
  const auto keys = differing_keys(a, b);
  if (keys.empty()) return;
  given.notes.push_back((own.file.empty() ? "the recording" : "the recording's own profile") +
                        std::string(" has other values of: ") + joined(keys));
}

Result<ChosenProfile> choose_for(const recording::Recording& index, const fs::path& config, const fs::path& folder) {
  RobotProfile base;
  const SourceEntry* lidar = lidar_of(index);
  if (lidar != nullptr) take_recorded(*lidar, base.lidar);
  if (config.empty()) {
    auto own = own_profile(folder, base);
    if (own && lidar != nullptr) take_recorded(*lidar, own->profile.lidar);
    return own;
  }
  auto given = load_profile(config, base);
  if (!given) return given.error();
  ChosenProfile chosen{.profile = std::move(*given), .file = config, .notes = {}};
  if (lidar != nullptr) keep_what_is_recorded(*lidar, chosen);
  auto own = own_profile(folder, base);
  if (!own) return chosen;  // its faults are of no interest where it is not used
  if (lidar != nullptr) take_recorded(*lidar, own->profile.lidar);
  if (own->file.empty()) {
    // Nothing but the mount is known of the robot that made it.
    RobotProfile mounted = chosen.profile;
    if (lidar != nullptr && lidar->base_sensor_xyz_rpy) mounted.lidar.base_xyz_rpy = own->profile.lidar.base_xyz_rpy;
    own->profile = std::move(mounted);
  }
  note_differences(*own, chosen);
  return chosen;
}

}  // namespace

Result<void> keep_profile(const fs::path& recording, const RobotProfile& profile) {
  return write_file_atomic(recording / recording::kProfileFile, to_yaml(profile));
}

std::vector<std::string> differing_keys(const RobotProfile& a, const RobotProfile& b) {
  // Both texts have the same lines, but for the values.
  std::istringstream one(to_yaml(a)), other(to_yaml(b));
  std::vector<std::string> keys, path;
  for (std::string left, right; std::getline(one, left) && std::getline(other, right);) {
    const std::size_t indent = std::min(left.find_first_not_of(' '), left.size());
    path.resize(std::min(path.size(), indent / 2));
    path.push_back(left.substr(indent, left.find(':') - indent));
    if (left == right) continue;
    std::string key;
    for (const std::string& part : path) key += (key.empty() ? "" : ".") + part;
    keys.push_back(std::move(key));
  }
  return keys;
}

Result<ChosenProfile> choose_profile(const fs::path& config, const fs::path& recording) {
  if (!recording.empty()) {
    const auto index = recording::load_recording(recording);
    if (!index) return index.error();
    return choose_for(*index, config, recording);
  }
  auto profile = load_profile(config);
  if (!profile) return profile.error();
  return ChosenProfile{.profile = std::move(*profile), .file = config, .notes = {}};
}

}  // namespace cairn::app
