// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "fusion/matching/features/map_features.hpp"
#include "hal/se3.hpp"
#include "tests/bench/pairs/survey.hpp"
#include "tools/simulator/motion/path.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::pairs {

/// A map with what is needed to match it and to tell where it lies.
struct Chart {
  std::unique_ptr<mapping::SemanticOcTree> map;
  std::unique_ptr<matching::MapFeatures> features;
  SE3 T_map_world;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // of its stops, in the world, m
};

/// The stops between two shares of a world's places, in order along a heading (rad), each a little off. At most 40.
[[nodiscard]] simulator::Path part(const simulator::World& world, double heading, double from, double to,
                                   simulator::Random& random);

/// A map frame of any heading, up to 10 m and `height_m` away from `about`, leaning by half to all of `lean_deg`.
[[nodiscard]] SE3 frame(simulator::Random& random, double height_m, double lean_deg, const Eigen::Vector3d& about);

/// The map of a robot that scans at these stops.
[[nodiscard]] Chart chart(const Ground& ground, const simulator::Path& stops, const Survey& how);

/// Whether a pose is right within 0.6 m and 6 degrees, in the middle of b: the book's protocol (section 4.6.3).
[[nodiscard]] bool is_right(const Chart& a, const Chart& b, const SE3& T_a_b);
/// The overlap (4.21) at the true pose.
[[nodiscard]] double overlap(const Chart& a, const Chart& b);
/// The true pose, off by up to 2 m and 15 degrees about b's origin.
[[nodiscard]] UncertainPose guess(const Chart& a, const Chart& b, simulator::Random& random);

}  // namespace cairn::pairs
