// SPDX-License-Identifier: Apache-2.0
#include "tools/team/figures/robot_result.hpp"

#include <nlohmann/json.hpp>

#include "hal/files/file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/figures/trajectory_error.hpp"

namespace cairn::team_run {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Result<Json> read_json(const fs::path& path) {
  constexpr std::uint64_t kMost = 64U << 20U;
  const auto bytes = read_file(path, kMost);
  if (!bytes) return bytes.error();
  const auto* text = reinterpret_cast<const char*>(bytes->data());
  Json json = Json::parse(text, text + bytes->size(), nullptr, false);
  if (!json.is_object()) return Error{Errc::kMalformed, "no JSON object", path.string()};
  return json;
}

/// A member, or null.
const Json& member(const Json& object, const char* key) {
  static const Json none;
  const auto found = object.is_object() ? object.find(key) : object.end();
  return object.is_object() && found != object.end() ? *found : none;
}

std::string text_of(const Json& json) { return json.is_string() ? json.get<std::string>() : std::string(); }

std::uint64_t count_of(const Json& json) { return json.is_number_unsigned() ? json.get<std::uint64_t>() : 0; }

/// A robot by its name or its id.
std::string robot_of(const Json& json, const std::vector<std::string>& names) {
  if (!json.is_number_unsigned()) return text_of(json);
  const auto id = json.get<std::uint64_t>();
  return id >= 1 && id <= names.size() ? names[id - 1] : std::string();
}

/// 16 numbers, row major.
std::optional<SE3> pose_of(const Json& json) {
  Eigen::Matrix4d m;
  if (!json.is_array() || json.size() != 16) return std::nullopt;
  for (Eigen::Index i = 0; i < 16; ++i) {
    const Json& number = json[static_cast<std::size_t>(i)];
    if (!number.is_number()) return std::nullopt;
    m(i / 4, i % 4) = number.get<double>();
  }
  if (!m.allFinite()) return std::nullopt;
  return SE3(Eigen::Matrix3d(m.topLeftCorner<3, 3>()), m.topRightCorner<3, 1>());
}

Result<void> take_team(const Json& report, const std::vector<std::string>& names, RobotResult& result) {
  const Json& team = member(report, "team");
  const Json& id = member(team, "id");
  const std::string own = id.is_number_unsigned() ? std::to_string(id.get<std::uint64_t>()) : std::string();
  const auto pose = pose_of(member(member(team, "T_team_odom"), own.c_str()));
  result.team_sha256 = text_of(member(team, "sha256"));
  result.anchor = robot_of(member(team, "anchor"), names);
  if (!pose || result.team_sha256.empty() || result.anchor.empty())
    return Error{Errc::kMalformed, "nothing about the team in the report", {}, {}, "id, T_team_odom, sha256, anchor"};
  result.T_team_odom = *pose;
  if (const Json& tiles = member(team, "tiles"); tiles.is_number_unsigned())
    result.own_tiles = tiles.get<std::uint64_t>();
  for (const Json& other : member(team, "merged_with")) result.merged_with.push_back(robot_of(other, names));
  return {};
}

void take_peers(const Json& report, RobotResult& result) {
  for (const auto& [name, peer] : member(report, "peers").items()) {
    result.reasons[name] = text_of(member(peer, "reason"));
    result.tiles_of_peer[name] = count_of(member(peer, "tiles"));
    const auto pose = pose_of(member(peer, "T_map_peer"));
    if (pose && member(peer, "accepted") == Json(true)) result.T_map_peer[name] = *pose;
  }
}

std::optional<Standing> standing_of(const std::vector<recording::StampedPose>& trajectory, const fs::path& truth_file) {
  const auto truth = recording::read_tum(truth_file);
  if (!truth) return std::nullopt;
  const auto matched = report::match_by_time(trajectory, *truth, report::TrajectoryErrorOptions{}.max_gap);
  if (matched.empty()) return std::nullopt;
  return Standing{matched.back().estimate, matched.back().truth};
}

}  // namespace

Result<RobotResult> read_robot_result(const fs::path& out, const fs::path& recorded,
                                      const std::vector<std::string>& names) {
  const fs::path file = out / "report.json";
  const auto report = read_json(file);
  if (!report) return report.error();
  RobotResult result;
  result.name = text_of(member(*report, "robot"));
  if (const auto taken = take_team(*report, names, result); !taken) return at(file.string(), taken.error());
  take_peers(*report, result);
  result.ticks = count_of(member(member(*report, "ticks"), "count"));
  result.missed_ticks = count_of(member(member(*report, "ticks"), "missed"));
  auto trajectory = recording::read_tum(out / "trajectory.tum");
  if (!trajectory) return trajectory.error();
  result.trajectory = *std::move(trajectory);
  result.standing = standing_of(result.trajectory, recorded / "ground_truth.tum");
  auto map = mapping::load_map(out / "team.cairn");
  if (!map) return at((out / "team.cairn").string(), map.error());
  result.team_map = *std::move(map);
  return result;
}

}  // namespace cairn::team_run
