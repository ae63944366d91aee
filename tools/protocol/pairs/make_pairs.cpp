// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/pairs/make_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tools/protocol/pairs/book.hpp"
#include "tools/protocol/pairs/halves.hpp"
#include "tools/protocol/pairs/map_pair.hpp"
#include "tools/protocol/pairs/recorded_map.hpp"

namespace cairn::protocol {
namespace {

namespace fs = std::filesystem;

// Of what is mapped. Chosen by hand, not tuned.
constexpr double kLidarRangeM = 20, kDepthRangeM = 10;

mapping::MappingConfig mapping(double range_m) {
  mapping::MappingConfig config;
  config.resolution_m = 0.1;
  config.max_range_m = range_m;
  return config;
}

/// Of a frame that begins where the robot begins, turned and lifted a little: no wall is to lie
/// along the grid, and the floor inside of a layer of voxels rather than between two.
SE3 T_map_world(const SE3& T_world_start, double yaw) {
  Vector6 turned;
  turned << 0.037, -0.021, 0.03, 0, 0, yaw;
  return SE3::from_xyz_rpy(turned) * T_world_start.inverse();
}

struct MadeMap {
  std::shared_ptr<const mapping::SemanticOcTree> map;
  SE3 T_map_world;
};

Result<MadeMap> made(const fs::path& recording, const Portion& portion, double yaw, double range_m) {
  const auto start = first_true_pose(recording);
  if (!start) return start.error();
  const SE3 T = T_map_world(*start, yaw);
  auto map = map_of_recording(recording, portion, T, mapping(range_m));
  if (!map) return map.error();
  return MadeMap{*std::move(map), T};
}

MapPair pair_of(std::string scene, const char* kind, const MadeMap& a, const MadeMap& b) {
  MapPair pair;
  pair.name = pair.scene = std::move(scene);
  pair.kind = kind;
  pair.a = a.map;
  pair.b = b.map;
  pair.T_a_b = a.T_map_world * b.T_map_world.inverse();
  return pair;
}

Result<void> make_scene(const PairsOptions& options, const BookScene& book) {
  const fs::path dir = options.recordings / book.world;
  const Portion all{recording::kVelodyne};
  const auto a = made(dir / "robot_1", all, 0.7, kLidarRangeM);
  if (!a) return a.error();
  const auto b = made(dir / "robot_2", all, 2.0, kLidarRangeM);
  if (!b) return b.error();
  const MapPair whole = pair_of(std::string(book.name), kScene, *a, *b);
  const Eigen::Vector3d along = a->T_map_world.rotation().col(0);  // the building's longer side
  if (auto saved = save_pair(cut_to_overlap(whole, along, book.overlap), options.out / whole.name); !saved)
    return saved;
  for (const int percent : kOverlapPercents) {
    MapPair cut = cut_to_overlap(whole, along, percent / 100.0);
    cut.kind = kOverlap;
    cut.name = fmt::format("{}_{}", book.name, percent);
    if (auto saved = save_pair(cut, options.out / cut.name); !saved) return saved;
  }
  return {};
}

/// The depth camera has seen the place; the LiDAR has turned a few times at rest, is half way, has
/// seen it all, too.
Result<void> make_heterogeneous(const PairsOptions& options) {
  const fs::path recording = options.recordings / "rgbd" / "robot_1";
  const auto a = made(recording, {recording::kDepth, 0, 3600, 2}, 0.7, kDepthRangeM);
  if (!a) return a.error();
  struct Phase {
    const char* name;
    double until_s;
  };
  for (const Phase& phase : {Phase{"start", 0.3}, Phase{"middle", 15}, Phase{"end", 3600}}) {
    const auto b = made(recording, {recording::kVelodyne, 0, phase.until_s}, 2.0, kDepthRangeM);
    if (!b) return b.error();
    MapPair pair = pair_of("lidar_rgbd", kHeterogeneous, *a, *b);
    pair.name += std::string("_") + phase.name;
    measure(pair);
    if (auto saved = save_pair(pair, options.out / pair.name); !saved) return saved;
  }
  return {};
}

Result<void> make_halves(const PairsOptions& options) {
  std::vector<fs::path> files;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(options.octomaps, code))
    if (entry.path().extension() == ".bt" || entry.path().extension() == ".ot") files.push_back(entry.path());
  if (code) return Error{Errc::kIo, "cannot read the folder", options.octomaps.string(), {}, code.message()};
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const auto whole = mapping::load_map(file);
    if (!whole) return at(file.string(), whole.error());
    HalvesOptions how;
    how.seed = options.seed;
    how.yaw = (79 + 51.0 * (options.seed % 360)) * std::numbers::pi / 180;
    MapPair pair = halves(**whole, file.stem().string(), how);
    measure(pair);
    if (auto saved = save_pair(pair, options.out / pair.name); !saved) return saved;
  }
  return {};
}

}  // namespace

Result<void> make_pairs(const PairsOptions& options) {
  for (const BookScene& scene : kBookScenes)
    if (auto done = make_scene(options, scene); !done) return done;
  if (auto done = make_heterogeneous(options); !done) return done;
  return options.octomaps.empty() ? Result<void>{} : make_halves(options);
}

}  // namespace cairn::protocol
