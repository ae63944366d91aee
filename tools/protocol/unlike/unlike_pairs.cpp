// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/unlike/unlike_pairs.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <vector>

#include "hal/files/file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tools/protocol/missions/run_frame.hpp"
#include "tools/protocol/pairs/json.hpp"
#include "tools/protocol/pairs/map_pair.hpp"

namespace cairn::protocol {
namespace {

namespace fs = std::filesystem;

constexpr const char *kUgv = "ugv_1", *kUav = "uav_1", *kMap = "map.cairn";
constexpr std::uint64_t kMaxMomentBytes = 1U << 20U;  // a bound on memory

Result<std::vector<std::string>> folders_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code))
    if (entry.is_directory(code) && !entry.is_symlink(code)) names.push_back(entry.path().filename().string());
  if (code) return Error{Errc::kIo, "cannot read the folder", folder.string(), {}, code.message()};
  std::ranges::sort(names);
  return names;
}

Result<void> make_pair(const UnlikeOptions& options, const std::string& scene, const std::string& number) {
  const fs::path run = options.runs / scene / number, recording = options.recordings / scene;
  const auto a = run_frame(run / kUgv, recording / kUgv), b = run_frame(run / kUav, recording / kUav);
  if (!a) return a.error();
  if (!b) return b.error();
  Moment moment{.seconds = std::max(a->seconds, b->seconds)};
  if (std::from_chars(number.data(), number.data() + number.size(), moment.fusion).ptr != number.data() + number.size())
    return Error{Errc::kMalformed, "the folder's name is not a number", run.string()};
  MapPair pair;
  pair.name = scene + '_' + number;
  pair.scene = scene;
  pair.kind = kUnlike;
  pair.T_a_b = a->T_world_odom.inverse() * b->T_world_odom;
  auto map_a = mapping::load_map(run / kUgv / kMap), map_b = mapping::load_map(run / kUav / kMap);
  if (!map_a) return at((run / kUgv / kMap).string(), map_a.error());
  if (!map_b) return at((run / kUav / kMap).string(), map_b.error());
  pair.a = *std::move(map_a);
  pair.b = *std::move(map_b);
  measure(pair);
  if (auto saved = save_pair(pair, options.out / pair.name); !saved) return saved;
  return save_moment(moment, options.out / pair.name / "moment.json");
}

}  // namespace

Result<void> save_moment(const Moment& moment, const fs::path& file) {
  const Json json = {{"fusion", moment.fusion}, {"seconds", moment.seconds}};
  return write_file_atomic(file, json.dump(1));
}

Result<Moment> load_moment(const fs::path& file) {
  const auto bytes = read_file(file, kMaxMomentBytes);
  if (!bytes) return bytes.error();
  try {
    const Json json = Json::parse(reinterpret_cast<const char*>(bytes->data()),
                                  reinterpret_cast<const char*>(bytes->data() + bytes->size()));
    return Moment{.fusion = json.at("fusion"), .seconds = json.at("seconds")};
  } catch (const nlohmann::json::exception& fault) {
    return Error{Errc::kMalformed, "not the moment of a fusion", file.string(), {}, fault.what()};
  }
}

Result<void> make_unlike(const UnlikeOptions& options) {
  const auto scenes = folders_in(options.runs);
  if (!scenes) return scenes.error();
  for (const std::string& scene : *scenes) {
    const auto numbers = folders_in(options.runs / scene);
    if (!numbers) return numbers.error();
    for (const std::string& number : *numbers)
      if (auto made = make_pair(options, scene, number); !made) return made;
  }
  if (scenes->empty()) return Error{Errc::kNotFound, "no runs", options.runs.string()};
  return {};
}

}  // namespace cairn::protocol
