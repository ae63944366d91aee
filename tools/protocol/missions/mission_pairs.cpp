// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/missions/mission_pairs.hpp"

#include <algorithm>

#include "onboard/mapping/files/map_file.hpp"
#include "tools/protocol/missions/mission.hpp"
#include "tools/protocol/missions/run_frame.hpp"
#include "tools/protocol/missions/told_states.hpp"
#include "tools/protocol/pairs/map_pair.hpp"

namespace cairn::protocol {
namespace {

namespace fs = std::filesystem;

constexpr const char *kFirst = "robot_1", *kSecond = "robot_2";

/// Of the LiDAR's packets and the cameras' pictures.
std::uint64_t raw_bytes(const fs::path& recording) {
  std::error_code code;
  std::uint64_t bytes = fs::file_size(recording / "lidar.pcap", code);
  for (const char* camera : {"camera", "thermal"})
    for (const auto& entry : fs::recursive_directory_iterator(recording / camera, code))
      if (entry.is_regular_file(code)) bytes += entry.file_size(code);
  return bytes;
}

/// What one robot adds to a mission; the larger figures stay.
Result<RunFrame> add_robot(const fs::path& run, const fs::path& recording, Mission& mission) {
  auto frame = run_frame(run, recording);
  if (!frame) return frame.error();
  const auto states = told_state_bytes(run);
  if (!states) return states.error();
  std::error_code code;
  const auto raw = static_cast<std::uint64_t>(static_cast<double>(raw_bytes(recording)) * std::min(1.0, frame->share));
  mission.seconds = std::max(mission.seconds, frame->seconds);
  mission.raw_bytes = std::max(mission.raw_bytes, raw);
  mission.map_bytes = std::max(mission.map_bytes, std::uint64_t{fs::file_size(run / "map.cairn", code)});
  if (code) return Error{Errc::kIo, "cannot read the map", (run / "map.cairn").string(), {}, code.message()};
  mission.states_bytes = std::max(mission.states_bytes, *states);
  return frame;
}

Result<void> make_mission(const MissionsOptions& options, Mission mission) {
  const fs::path run = options.runs / mission.light / mission.pipeline / mission.phase,
                 recording = options.recordings / mission.light;
  const auto a = add_robot(run / kFirst, recording / kFirst, mission);
  if (!a) return a.error();
  const auto b = add_robot(run / kSecond, recording / kSecond, mission);
  if (!b) return b.error();
  mission.T_world_a = a->T_world_odom;
  mission.world = recording / kFirst / "world.ot";
  MapPair pair;
  pair.name = name_of(mission);
  pair.scene = mission.light;
  pair.kind = kMission;
  pair.T_a_b = a->T_world_odom.inverse() * b->T_world_odom;
  auto map_a = mapping::load_map(run / kFirst / "map.cairn");
  if (!map_a) return map_a.error();
  auto map_b = mapping::load_map(run / kSecond / "map.cairn");
  if (!map_b) return map_b.error();
  pair.a = *std::move(map_a);
  pair.b = *std::move(map_b);
  measure(pair);
  if (auto saved = save_pair(pair, options.out / pair.name); !saved) return saved;
  return save_mission(mission, options.out / pair.name / "mission.json");
}

}  // namespace

Result<void> make_missions(const MissionsOptions& options) {
  for (const char* light : kLights)
    for (const char* pipeline : kPipelines)
      for (const char* phase : kPhases)
        if (auto made = make_mission(
                options, {.light = light, .pipeline = pipeline, .phase = phase, .T_world_a = {}, .world = {}});
            !made)
          return made;
  return {};
}

}  // namespace cairn::protocol
