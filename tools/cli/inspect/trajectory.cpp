// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/trajectory.hpp"

#include <nlohmann/json.hpp>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "hal/files/file.hpp"

namespace cairn::cli {

report::Json describe_trajectory(const std::filesystem::path& path) {
  report::Json json;
  std::vector<recording::StampedPose> poses;
  const auto bytes = read_file(path, recording::kMaxTrajectoryBytes);
  if (!bytes) return {{"poses", 0}, {"damage", to_string(bytes.error())}};
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  const auto parsed = recording::parse_tum(text, path.string(), poses);
  double length = 0;
  for (std::size_t i = 1; i < poses.size(); ++i)
    length += (poses[i].pose.translation() - poses[i - 1].pose.translation()).norm();
  json["poses"] = poses.size();
  json["length_m"] = length;
  if (!poses.empty()) {
    json["first_s"] = to_seconds(poses.front().stamp);
    json["last_s"] = to_seconds(poses.back().stamp);
    json["duration_s"] = to_seconds(poses.back().stamp - poses.front().stamp);
  }
  json["damage"] = parsed ? report::Json(nullptr) : report::Json(to_string(parsed.error()));
  return json;
}

}  // namespace cairn::cli
