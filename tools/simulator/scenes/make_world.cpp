// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/scenes/make_world.hpp"

#include <array>

#include "tools/simulator/scenes/scenes.hpp"

namespace cairn::simulator {
namespace {

struct Scene {
  const char* name;
  World (*make)();
};
constexpr std::array<Scene, 8> kScenes{{{"corridor", scenes::corridor},
                                        {"hallway", scenes::hallway},
                                        {"lobby", scenes::lobby},
                                        {"office", scenes::office},
                                        {"carpark", scenes::carpark},
                                        {"forest", scenes::forest},
                                        {"street", scenes::street},
                                        {"tramstop", scenes::tramstop}}};

/// Scenes are drawn in whole centimetres. Real walls do not stand on the faces of somebody's 0.1 m voxels, where
/// rounding alone decides which voxel is hit; moved by this, neither do these.
const Eigen::Vector3d kOffLattice{0.037, 0.023, 0.016};

World settle(World world) {
  world.mesh.translate(kOffLattice);
  for (Eigen::Vector2d& p : world.places) p += kOffLattice.head<2>();
  world.ground = [height = std::move(world.ground)](double x, double y) {
    return height(x - kOffLattice.x(), y - kOffLattice.y()) + kOffLattice.z();
  };
  world.bounds = world.mesh.bounds();
  return world;
}

}  // namespace

const std::vector<std::string>& scene_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Scene& scene : kScenes) all.emplace_back(scene.name);
    return all;
  }();
  return names;
}

Result<World> make_world(std::string_view name) {
  for (const Scene& scene : kScenes) {
    if (name != scene.name) continue;
    World world = scene.make();
    world.name = name;
    return settle(std::move(world));
  }
  Error error{Errc::kNotFound, "no such scene", std::string(name), {}, "known scenes:"};
  for (const std::string& known : scene_names()) error.detail += ' ' + known;
  return error;
}

}  // namespace cairn::simulator
