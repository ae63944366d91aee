// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/missions/mission.hpp"

#include "hal/files/file.hpp"
#include "tools/protocol/pairs/json.hpp"

namespace cairn::protocol {
namespace {

constexpr std::uint64_t kMaxMissionBytes = 1U << 20U;  // a bound on memory

}  // namespace

std::string name_of(const Mission& mission) { return mission.light + '_' + mission.pipeline + '_' + mission.phase; }

Result<void> save_mission(const Mission& m, const std::filesystem::path& file) {
  const Json json = {{"light", m.light},
                     {"pipeline", m.pipeline},
                     {"phase", m.phase},
                     {"seconds", m.seconds},
                     {"raw_bytes", m.raw_bytes},
                     {"map_bytes", m.map_bytes},
                     {"states_bytes", m.states_bytes},
                     {"world", m.world.string()},
                     {"T_world_a", pose_to_json(m.T_world_a)}};
  return write_file_atomic(file, json.dump(1));
}

Result<Mission> load_mission(const std::filesystem::path& file) {
  const auto bytes = read_file(file, kMaxMissionBytes);
  if (!bytes) return bytes.error();
  try {
    const Json json = Json::parse(reinterpret_cast<const char*>(bytes->data()),
                                  reinterpret_cast<const char*>(bytes->data() + bytes->size()));
    return Mission{.light = json.at("light"),
                   .pipeline = json.at("pipeline"),
                   .phase = json.at("phase"),
                   .seconds = json.at("seconds"),
                   .raw_bytes = json.at("raw_bytes"),
                   .map_bytes = json.at("map_bytes"),
                   .states_bytes = json.at("states_bytes"),
                   .T_world_a = pose_from_json(json.at("T_world_a")),
                   .world = json.at("world").get<std::string>()};
  } catch (const nlohmann::json::exception& fault) {
    return Error{Errc::kMalformed, "not the description of a mission", file.string(), {}, fault.what()};
  }
}

}  // namespace cairn::protocol
