// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <string>
#include <vector>

#include "tests/support/box_world.hpp"
#include "tests/support/drive_path.hpp"

namespace cairn::support {

struct Scene {
  std::string name;
  World world;
  Ride ride;
};

inline Ride ellipse(double cx, double cy, double a, double b) {
  Ride ride;
  ride.curve = [=](double phi) { return Eigen::Vector2d(cx + a * std::sin(phi), cy - b * std::cos(phi)); };
  return ride;
}

/// 20 × 5 × 3 m with door niches.
inline Scene corridor() {
  Scene s{"corridor", {}, ellipse(10, 2.5, 7.5, 1.2)};
  s.world.box({0, 0, 0}, {20, 5, 3});
  for (const double x : {3.0, 8.0, 13.0}) s.world.box({x, -0.5, 0}, {x + 1, 0.06, 2.1});
  for (const double x : {5.5, 15.5}) s.world.box({x, 4.92, 0}, {x + 1, 5.5, 2.1});
  return s;
}

/// No ends, no features: nothing tells how far along x.
inline Scene endless_corridor() {
  Scene s{"endless", {}, ellipse(0, 2.5, 15, 0.8)};
  s.world.plane({0, 1, 0}, 0).plane({0, 1, 0}, 5).plane({0, 0, 1}, 0).plane({0, 0, 1}, 3);
  return s;
}

/// 40 × 15 × 3 m with pillars, a reception desk, benches.
inline Scene lobby() {
  Scene s{"lobby", {}, ellipse(20, 7.5, 14, 4)};
  s.world.box({0, 0, 0}, {40, 15, 3});
  for (double x = 6; x < 40; x += 7)
    for (const double y : {6.0, 9.0}) s.world.box({x, y, 0}, {x + 0.5, y + 0.5, 3});
  s.world.box({17, 7, 0}, {23, 8, 1.1}).box({1, 1, 0}, {3, 1.5, 0.45}).box({30, 13.5, 0}, {33, 14.2, 0.45});
  return s;
}

/// 50 × 40 × 3 m: a ring of corridors around two rows of rooms, with desks.
inline Scene office() {
  Scene s{"office", {}, {}};
  s.world.box({0, 0, 0}, {50, 40, 3});
  const auto wall = [&s](double x0, double y0, double x1, double y1) { s.world.box({x0, y0, 0}, {x1, y1, 3}); };
  for (int i = 0; i < 6; ++i) {
    const double x = 6 + 6.5 * i;
    for (const double y : {4.0, 24.0}) {
      wall(x, y, x + 0.15, y + 12);
      wall(x, y, x + 2.4, y + 0.15);
      wall(x + 3.4, y, x + 6.5, y + 0.15);
      wall(x, y + 12, x + 2.4, y + 12.15);
      wall(x + 3.4, y + 12, x + 6.5, y + 12.15);
      s.world.box({x + 1, y + 3, 0.7}, {x + 2.6, y + 3.8, 0.75}).box({x + 4, y + 8, 0}, {x + 4.5, y + 10, 1.8});
    }
  }
  s.ride = ellipse(25, 20, 21.5, 17.9);
  s.ride.curve = [](double phi) {  // a rounded rectangle through the outer corridors
    const double c = std::cos(phi), n = std::sin(phi), r = std::pow(std::pow(c, 8) + std::pow(n, 8), -0.125);
    return Eigen::Vector2d(25 + 22.5 * r * n, 20 - 18 * r * c);
  };
  return s;
}

/// 60 × 40 m hall, 2.6 m high, pillars and rows of cars.
inline Scene carpark() {
  Scene s{"carpark", {}, ellipse(30, 20, 22, 12)};
  s.world.box({0, 0, 0}, {60, 40, 2.6});
  for (double x = 8; x < 60; x += 8)
    for (double y = 8; y < 40; y += 8) s.world.box({x, y, 0}, {x + 0.4, y + 0.4, 2.6});
  for (int i = 0; i < 14; ++i) {
    if (i % 5 == 3) continue;
    const double x = 3 + 2.7 * i;
    s.world.box({x, 1, 0.2}, {x + 1.8, 5.2, 0.9}).box({x + 0.1, 2, 0.9}, {x + 1.7, 4.2, 1.5});
    s.world.box({x + 9, 17, 0.2}, {x + 10.8, 21.2, 0.9}).box({x + 9.1, 18, 0.9}, {x + 10.7, 20.2, 1.5});
  }
  return s;
}

/// Trunks on a slope of 8 %, no walls anywhere.
inline Scene forest() {
  Scene s{"forest", {}, ellipse(0, 0, 20, 11)};
  const double slope = 0.08;
  s.world.plane({-slope, 0, 1}, 0);
  s.ride.ground = [=](double x, double) { return slope * x; };
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(-60, 60), thick(0.1, 0.35);
  for (int i = 0; i < 500; ++i) {
    const double x = at(random), y = at(random), r = thick(random);
    const double e = std::hypot(x / 20, y / 11);
    if (std::abs(e - 1) * 11 > 1.5) s.world.trunk(x, y, r);
  }
  return s;
}

inline std::vector<Scene> all_scenes() {
  return {corridor(), lobby(), office(), carpark(), forest(), endless_corridor()};
}

}  // namespace cairn::support
