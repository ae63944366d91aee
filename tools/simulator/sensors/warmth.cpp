// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/warmth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "tools/simulator/sensors/look.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

/// Kelvins above the air: `shade` by day, `sun` more where it shines squarely, `night` after sunset.
struct Warmth {
  double shade = 0, sun = 0, night = 0, emissivity = 1;
};

constexpr std::array<Warmth, kMaterials> warmths() {
  using enum Material;
  std::array<Warmth, kMaterials> all{};
  for (Warmth& w : all) w = {0.0, 8.0, 0.0, 0.94};
  const auto set = [&](std::initializer_list<Material> materials, const Warmth& warmth) {
    for (const Material m : materials) all[static_cast<std::size_t>(m)] = warmth;
  };
  set({kAsphalt, kRoadPaint}, {3.0, 20.0, 4.0, 0.95});
  set({kBrick, kStoneWall, kConcrete, kRoofTile, kRender, kPavement, kKerb, kRock}, {1.0, 15.0, 3.0, 0.93});
  set({kGrass, kLeaves, kBark, kSoil}, {-1.0, 5.0, -1.5, 0.97});
  set({kWindow, kGlass, kVehicleGlass, kTramGlass, kDarkGlass, kClearGlass}, {0.5, 4.0, 2.0, 0.85});
  set({kCarPaintLight, kCarPaintDark, kBusPaint, kTruckPaint, kTramPaint, kMotorcycle}, {1.0, 17.0, -3.0, 0.90});
  set({kMetal, kPole, kRetroreflector, kTrafficLight, kBicycle}, {0.5, 9.0, -2.0, 0.80});
  set({kScreen}, {7.0, 0.0, 7.0, 0.92});
  return all;
}
constexpr std::array<Warmth, kMaterials> kWarmths = warmths();

/// People who walk, and riders, who are part of the world.
bool is_body(const Sighting& s) { return s.person >= 0 || s.class_id() == kRiderClass; }

bool is_skin(Material m) { return m == Material::kSkin || m == Material::kRiderSkin; }

/// Skin 34.5 °C, the face warmest; clothes halfway to the air; hair between.
double body_celsius(const Sighting& s, const Climate& climate) {
  const double each = Random(7, static_cast<std::uint64_t>(s.person)).uniform(-0.6, 0.6);
  const double cover = 0.4 * (value_noise(s.pattern / 0.12) - 0.5);
  if (is_skin(s.material)) return 34.6 + each + cover;
  const double share = s.material == Material::kHair ? 0.6 : 0.5;
  return climate.air_c + share * (33.0 - climate.air_c) + each + 3.0 * cover;
}

double own_celsius(const Sighting& s, const Climate& climate, const Instant& instant, const Warmth& w) {
  const bool sunlit = climate.may_be_sunlit(s.normal) && instant.sunlit(s.point, s.normal, climate.sun);
  const double sun = sunlit ? s.normal.dot(climate.sun) : 0.0;
  if (is_body(s)) return body_celsius(s, climate) + (is_skin(s.material) ? 0.5 : 5.0) * sun;
  const double rough = 0.8 * (value_noise(s.pattern / 0.4) - 0.5);
  const double base = climate.open_air ? (climate.night ? w.night : w.shade) : 0.3 * w.shade;
  return climate.air_c + base + w.sun * sun + rough;
}

double fourth(double celsius) { return std::pow(celsius + 273.15, 4); }

}  // namespace

double apparent_celsius(const Sighting& s, const Climate& climate, const Instant& instant) {
  if (s.sky()) return climate.sky_c(s.direction);
  const Warmth w = is_body(s) ? Warmth{0, 0, 0, 0.98} : kWarmths[static_cast<std::size_t>(s.material)];
  const Eigen::Vector3d mirrored = s.direction - 2 * s.normal.dot(s.direction) * s.normal;
  const double around = mirrored.z() > 0 ? climate.sky_c(mirrored) : climate.air_c;
  const double own = own_celsius(s, climate, instant, w);
  return std::pow(w.emissivity * fourth(own) + (1 - w.emissivity) * fourth(around), 0.25) - 273.15;
}

}  // namespace cairn::simulator
