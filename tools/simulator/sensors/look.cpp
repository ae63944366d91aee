// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/look.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

using Eigen::Vector3d;

enum class Pattern : std::uint8_t { kMottled, kBricks, kSlabs, kBoards, kGrain };

/// What of a material eyes see. `size` in metres: of the pattern's largest features; `contrast` is the share by which
/// it makes the colour brighter and darker; `gloss` the reflection at normal incidence (Schlick, 1994).
struct Look {
  float red, green, blue;
  Pattern pattern;
  double size, contrast, gloss;
};

// In the order of the enum.
constexpr std::array<Look, kMaterials> kLooks{{
    {0.72F, 0.70F, 0.66F, Pattern::kMottled, 0.6, 0.10, 0},     // plaster
    {0.42F, 0.41F, 0.40F, Pattern::kMottled, 0.5, 0.30, 0},     // concrete
    {0.80F, 0.80F, 0.78F, Pattern::kSlabs, 0.6, 0.06, 0},       // ceiling
    {0.20F, 0.22F, 0.27F, Pattern::kMottled, 0.08, 0.35, 0},    // carpet
    {0.50F, 0.46F, 0.40F, Pattern::kSlabs, 0.6, 0.18, 0.03},    // stone floor
    {0.13F, 0.13F, 0.14F, Pattern::kMottled, 0.12, 0.40, 0},    // asphalt
    {0.45F, 0.28F, 0.16F, Pattern::kBoards, 0.25, 0.15, 0.02},  // door
    {0.60F, 0.60F, 0.62F, Pattern::kMottled, 0.5, 0.05, 0.02},  // door frame
    {0.50F, 0.34F, 0.20F, Pattern::kBoards, 0.12, 0.30, 0.02},  // wood
    {0.18F, 0.20F, 0.34F, Pattern::kMottled, 0.05, 0.25, 0},    // fabric
    {0.45F, 0.46F, 0.48F, Pattern::kMottled, 0.3, 0.10, 0.10},  // metal
    {0.03F, 0.03F, 0.04F, Pattern::kMottled, 0.5, 0.10, 0.05},  // screen
    {0.07F, 0.09F, 0.10F, Pattern::kMottled, 1.0, 0.10, 0.08},  // glass
    {0.03F, 0.03F, 0.04F, Pattern::kMottled, 1.0, 0.10, 0.06},  // dark glass
    {0.82F, 0.82F, 0.78F, Pattern::kMottled, 0.4, 0.06, 0},     // paint
    {0.80F, 0.12F, 0.10F, Pattern::kMottled, 0.3, 0.10, 0},     // retro-reflector
    {0.70F, 0.71F, 0.72F, Pattern::kMottled, 1.5, 0.04, 0.05},  // light car paint
    {0.10F, 0.06F, 0.20F, Pattern::kMottled, 1.5, 0.10, 0.05},  // dark car paint
    {0.03F, 0.03F, 0.03F, Pattern::kMottled, 0.1, 0.30, 0},     // tyre
    {0.35F, 0.37F, 0.38F, Pattern::kMottled, 0.3, 0.15, 0.03},  // pole
    {0.48F, 0.46F, 0.44F, Pattern::kSlabs, 0.9, 0.20, 0},       // kerb
    {0.24F, 0.18F, 0.11F, Pattern::kGrain, 0.5, 0.50, 0},       // soil
    {0.22F, 0.16F, 0.11F, Pattern::kGrain, 0.08, 0.50, 0},      // bark
    {0.12F, 0.24F, 0.06F, Pattern::kGrain, 0.2, 0.55, 0},       // leaves
    {0.36F, 0.35F, 0.33F, Pattern::kMottled, 0.3, 0.40, 0},     // rock
    {0.11F, 0.19F, 0.05F, Pattern::kGrain, 0.30, 0.55, 0},      // grass
    {0.44F, 0.42F, 0.40F, Pattern::kSlabs, 0.4, 0.25, 0},       // pavement
    {0.78F, 0.78F, 0.76F, Pattern::kMottled, 0.2, 0.20, 0},     // road paint
    {0.42F, 0.20F, 0.14F, Pattern::kBricks, 0.25, 0.35, 0},     // brick
    {0.68F, 0.62F, 0.48F, Pattern::kMottled, 0.8, 0.12, 0},     // render
    {0.36F, 0.15F, 0.10F, Pattern::kBricks, 0.3, 0.30, 0},      // roof tile
    {0.06F, 0.08F, 0.10F, Pattern::kMottled, 1.0, 0.20, 0.10},  // window
    {0.40F, 0.37F, 0.32F, Pattern::kBricks, 0.5, 0.40, 0},      // stone wall
    {0.34F, 0.24F, 0.15F, Pattern::kBoards, 0.14, 0.30, 0},     // fence
    {0.05F, 0.06F, 0.05F, Pattern::kMottled, 0.3, 0.10, 0.02},  // traffic light
    {0.75F, 0.45F, 0.05F, Pattern::kMottled, 2.0, 0.05, 0.04},  // bus paint
    {0.15F, 0.25F, 0.50F, Pattern::kMottled, 1.0, 0.05, 0.04},  // truck paint
    {0.55F, 0.56F, 0.52F, Pattern::kMottled, 0.7, 0.15, 0},     // tarpaulin
    {0.08F, 0.20F, 0.32F, Pattern::kMottled, 0.2, 0.10, 0.04},  // bicycle
    {0.30F, 0.04F, 0.04F, Pattern::kMottled, 0.3, 0.10, 0.05},  // motorcycle
    {0.04F, 0.05F, 0.06F, Pattern::kMottled, 1.0, 0.10, 0.10},  // vehicle glass
    {0.58F, 0.38F, 0.28F, Pattern::kMottled, 0.1, 0.08, 0},     // skin
    {0.07F, 0.05F, 0.03F, Pattern::kGrain, 0.04, 0.40, 0},      // hair
    {0.06F, 0.06F, 0.08F, Pattern::kMottled, 0.12, 0.30, 0},    // dark clothes
    {0.08F, 0.14F, 0.35F, Pattern::kMottled, 0.12, 0.30, 0},    // blue clothes
    {0.50F, 0.08F, 0.08F, Pattern::kMottled, 0.12, 0.25, 0},    // red clothes
    {0.65F, 0.63F, 0.58F, Pattern::kMottled, 0.12, 0.20, 0},    // light clothes
    {0.62F, 0.06F, 0.05F, Pattern::kMottled, 2.0, 0.05, 0.04},  // tram paint
    {0.05F, 0.06F, 0.07F, Pattern::kMottled, 1.0, 0.10, 0.10},  // tram glass
    {0.58F, 0.38F, 0.28F, Pattern::kMottled, 0.1, 0.08, 0},     // a rider's skin
    {0.66F, 0.60F, 0.08F, Pattern::kMottled, 0.12, 0.20, 0},    // a rider's clothes
    {0.07F, 0.07F, 0.09F, Pattern::kMottled, 0.12, 0.30, 0},    // a rider's dark parts
    {0.07F, 0.09F, 0.10F, Pattern::kMottled, 1.0, 0.10, 0.08},  // clear glass
}};

double hashed(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto u = [](std::int64_t v) { return static_cast<std::uint64_t>(v); };
  const std::uint64_t key = u(x) * 0x9e3779b97f4a7c15U ^ u(y) * 0xc2b2ae3d27d4eb4fU ^ u(z) * 0x165667b19e3779f9U;
  return static_cast<double>(mix(key) >> 40U) * 0x1p-24;
}

/// How much of a feature of `size` is left when a pixel covers `footprint`.
double kept(double size, double footprint) { return std::clamp(1.5 - 2.0 * footprint / size, 0.0, 1.0); }

/// Coordinates in the surface's plane: along it level, and up it (or north, on floors).
Eigen::Vector2d on_surface(const Vector3d& p, const Vector3d& n) {
  if (std::abs(n.z()) > 0.7) return p.head<2>();
  const double norm = std::max(1e-9, std::hypot(n.x(), n.y()));
  return {(p.y() * n.x() - p.x() * n.y()) / norm, p.z()};
}

/// Stones of `length` × `height` with joints, every one a little different; each course begins elsewhere.
double stones(const Eigen::Vector2d& p, double length, double height, double offset, double footprint) {
  const double row = std::floor(p.y() / height), x = p.x() / length + offset * row, column = std::floor(x);
  const double in_x = (x - column) * length, in_y = p.y() - row * height, joint = 0.035 * length;
  const double stone = hashed(static_cast<std::int64_t>(column), static_cast<std::int64_t>(row), 17) - 0.5;
  const bool gap = in_x < joint || in_y < joint;
  return gap ? 1.2 * kept(3 * joint, footprint) : stone * kept(height, footprint);
}

double patterned(const Look& look, const Vector3d& p, const Vector3d& n, double footprint) {
  const auto cloud = [&](double size) { return (value_noise(p / size) - 0.5) * kept(size, footprint); };
  switch (look.pattern) {
    case Pattern::kBricks:
      return stones(on_surface(p, n), look.size, 0.32 * look.size, 0.5, footprint) + 0.5 * cloud(0.4 * look.size);
    case Pattern::kSlabs:
      return -stones(on_surface(p, n), look.size, look.size, 0.0, footprint) + 0.6 * cloud(0.15 * look.size);
    case Pattern::kBoards:
      return stones(on_surface(p, n), look.size, 40.0, 0.0, footprint) + cloud(0.3 * look.size);
    case Pattern::kGrain:
      return cloud(look.size) + 1.1 * cloud(0.16 * look.size) + 0.5 * cloud(6 * look.size);
    case Pattern::kMottled:
      break;
  }
  return cloud(look.size) + 0.7 * cloud(0.22 * look.size);
}

}  // namespace

double value_noise(const Vector3d& p) {
  const Vector3d floor = p.array().floor();
  const Vector3d f = p - floor, s = f.array().square() * (3.0 - 2.0 * f.array());
  const auto x = static_cast<std::int64_t>(floor.x()), y = static_cast<std::int64_t>(floor.y()),
             z = static_cast<std::int64_t>(floor.z());
  const auto edge = [&](std::int64_t dy, std::int64_t dz) {
    return (1 - s.x()) * hashed(x, y + dy, z + dz) + s.x() * hashed(x + 1, y + dy, z + dz);
  };
  return (1 - s.z()) * ((1 - s.y()) * edge(0, 0) + s.y() * edge(1, 0)) +
         s.z() * ((1 - s.y()) * edge(0, 1) + s.y() * edge(1, 1));
}

Rgb albedo(Material material, const Vector3d& pattern, const Vector3d& normal, double footprint) {
  const Look& look = kLooks[static_cast<std::size_t>(material)];
  const double factor = 1.0 + 2.0 * look.contrast * patterned(look, pattern, normal, footprint);
  const auto clamped = static_cast<float>(std::clamp(factor, 0.1, 1.9));
  return (clamped * Rgb(look.red, look.green, look.blue)).cwiseMin(0.95F);
}

namespace {

/// Light from where a mirror with this normal lets one look.
Rgb mirrored_light(const Vector3d& direction, const Vector3d& normal, const Climate& climate) {
  const Vector3d mirrored = direction - 2 * normal.dot(direction) * normal;
  const bool up = climate.open_air && mirrored.z() > 0;
  return up ? climate.sky(mirrored) : Rgb(0.3F * climate.light(-mirrored, false));
}

Rgb surface_radiance(const Sighting& s, const Climate& climate, const Instant& instant, double pixel_rad) {
  if (s.sky()) return climate.sky(s.direction);
  const bool sunlit = climate.may_be_sunlit(s.normal) && instant.sunlit(s.point, s.normal, climate.sun);
  const Rgb diffuse =
      albedo(s.material, s.pattern, s.normal, s.distance * pixel_rad).cwiseProduct(climate.light(s.normal, sunlit));
  const double gloss = kLooks[static_cast<std::size_t>(s.material)].gloss;
  if (gloss == 0) return diffuse;
  const double cosine = std::clamp(-s.normal.dot(s.direction), 0.0, 1.0);
  const auto share = static_cast<float>(gloss + (1 - gloss) * std::pow(1 - cosine, 5));
  return (1 - share) * diffuse + share * mirrored_light(s.direction, s.normal, climate);
}

}  // namespace

Rgb radiance(const Sighting& s, const Climate& climate, const Instant& instant, double pixel_rad) {
  const Rgb behind = surface_radiance(s, climate, instant, pixel_rad);
  if (s.through == 1) return behind;
  const auto through = static_cast<float>(s.through);
  return through * behind + (1 - through) * mirrored_light(s.direction, s.pane, climate);
}

}  // namespace cairn::simulator
