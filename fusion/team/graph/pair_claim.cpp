// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/graph/pair_claim.hpp"

#include <tuple>

namespace cairn::team {
bool before(const PairClaim& x, const PairClaim& y) {
  const auto key = [](const PairClaim& c) {
    const Vector6 T = c.T_a_b.mean.log();
    return std::tuple(-c.probability, c.a, c.b, c.submap_a, c.submap_b, T[0], T[1], T[2], T[3], T[4], T[5]);
  };
  return key(x) < key(y);
}

std::size_t submaps_of(const SubmapChains& chains, peers::RobotId robot) {
  const auto chain = chains.find(robot);
  return chain == chains.end() ? 1 : chain->second.size() + 1;
}

SE3 place_in_odom(const SubmapChains& chains, peers::RobotId robot, std::size_t submap) {
  return submap == 0 ? SE3() : chains.at(robot)[submap - 1].mean;
}

UncertainPose motion(const SubmapChains& chains, peers::RobotId robot, std::size_t from, std::size_t to) {
  if (from > to) return inverse(motion(chains, robot, to, from));  // NOLINT(misc-no-recursion): once
  UncertainPose way;
  for (std::size_t k = from; k < to; ++k) {
    const UncertainPose& next = chains.at(robot)[k];
    way = compose(way, {place_in_odom(chains, robot, k).inverse() * next.mean, next.covariance});
  }
  return way;
}

}  // namespace cairn::team
