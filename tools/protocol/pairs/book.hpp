// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace cairn::protocol {

/// Numbers of Yue & Wang, "Collaborative Perception, Localization and Mapping for Autonomous
/// Systems" (Springer 2021), for comparison. Numbers that the text at hand does not have are left
/// out.

/// Mean errors (Table 4.3).
struct BookError {
  std::string_view method;
  double deg, m;
};
/// Table 4.2, and the overlap of section 4.6.4.
struct BookScene {
  std::string_view name, world, place;  ///< world: the simulator's scene of the same size
  double overlap;
  int voxels, edges;
  std::array<BookError, 5> errors;
  double icp_seconds;  ///< Table 4.4
};
inline constexpr std::array kBookScenes{BookScene{"corridor",
                                                  "hallway",
                                                  "Corridor",
                                                  0.48,
                                                  46000,
                                                  3500,
                                                  {{{"icp", 31.39, 1.63},
                                                    {"p2plane", 19.97, 1.51},
                                                    {"gicp", 10.58, 1.71},
                                                    {"ndt", 13.63, 2.56},
                                                    {"pmm_level1", 12.06, 0.62}}},
                                                  3.14},
                                        BookScene{"lobby",
                                                  "lobby",
                                                  "WKW lobby",
                                                  0.42,
                                                  67071,
                                                  4300,
                                                  {{{"icp", 5.77, 1.95},
                                                    {"p2plane", 6.31, 1.78},
                                                    {"gicp", 5.32, 2.84},
                                                    {"ndt", 5.51, 2.32},
                                                    {"pmm_level1", 6.90, 1.47}}},
                                                  10.35},
                                        BookScene{"office",
                                                  "office",
                                                  "Willow office",
                                                  0.40,
                                                  76000,
                                                  3200,
                                                  {{{"icp", 6.54, 3.60},
                                                    {"p2plane", 4.97, 2.78},
                                                    {"gicp", 5.28, 2.72},
                                                    {"ndt", 8.07, 5.13},
                                                    {"pmm_level1", 8.88, 2.54}}},
                                                  5.59}};

/// Of Fig. 4.10: from 45 % on, a metre at a time.
inline constexpr std::array kOverlapPercents{45, 40, 35, 30, 25, 20, 15, 10};

/// RMS of matched voxels at the beginning, in the middle and at the end, m (Table 5.2).
struct BookRms {
  std::string_view place;
  std::array<double, 3> oicp, em;
};
inline constexpr std::array kBookRms{
    BookRms{"indoor", {0.3414, 0.2592, 0.2675}, {0.2479, 0.2357, 0.2890}},
    BookRms{"mixed", {0.3140, 0.3078, 0.2818}, {0.2791, 0.2563, 0.2542}},
    BookRms{"Changi exhibition centre", {0.4405, 0.4054, 0.3653}, {0.4284, 0.3998, 0.3550}},
    BookRms{"forest", {0.4393, 0.3561, 0.3430}, {0.4301, 0.3374, 0.3237}}};
/// The same among people, by day and by night (Table 6.2).
struct BookPeopleRms {
  std::string_view light;
  std::array<double, 3> jessup, ours;
};
inline constexpr std::array kBookPeopleRms{BookPeopleRms{"day", {0.4221, 0.3411, 0.3256}, {0.4004, 0.3354, 0.3183}},
                                           BookPeopleRms{"night", {0.4247, 0.3171, 0.2980}, {0.4173, 0.3095, 0.2908}}};
/// Mean entropies of two robots' maps and of the fused one (Table 7.5). The text at hand has lost
/// the table's rows. Read column by column, as here, the overall value lies between the other two
/// everywhere. Read row by row it lies below both.
struct BookFused {
  std::string_view place;
  std::array<double, 3> occupancy, label, overall;  ///< map 1, map 2, fused
};
inline constexpr std::array kBookFused{
    BookFused{"open car park, two UGVs", {.4030, .3689, .3439}, {.3088, .3239, .2833}, {.3291, .3349, .3098}},
    BookFused{"WKW lobby, two UGVs", {.3929, .3653, .3267}, {.3285, .3327, .2930}, {.3476, .3527, .3157}},
    BookFused{"UAV and UGV", {.3712, .3429, .3078}, {.2849, .2937, .2715}, {.3161, .3229, .2895}}};

/// Two labels of one voxel and the fused one (Tables 7.3 and 7.4); classes are trainIds.
struct BookLabels {
  std::string_view table;
  unsigned class_1;
  double p_1;
  unsigned class_2;
  double p_2;
  unsigned fused_class;
  double fused_p;
};
inline constexpr unsigned kRoad = 0, kCar = 13;
inline constexpr std::array kBookLabels{
    BookLabels{"7.3", kRoad, .638, kCar, .973, kCar, .894},   BookLabels{"7.3", kRoad, .711, kCar, .985, kCar, .969},
    BookLabels{"7.3", kRoad, .834, kCar, .992, kCar, .977},   BookLabels{"7.4", kRoad, .695, kRoad, .773, kRoad, .784},
    BookLabels{"7.4", kRoad, .810, kRoad, .855, kRoad, .886}, BookLabels{"7.4", kRoad, .906, kRoad, .924, kRoad, .943}};

[[nodiscard]] inline std::optional<BookError> book_error(std::string_view scene, std::string_view method) {
  for (const BookScene& s : kBookScenes)
    for (const BookError& e : s.errors)
      if (s.name == scene && e.method == method) return e;
  return std::nullopt;
}

}  // namespace cairn::protocol
