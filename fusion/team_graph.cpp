// SPDX-License-Identifier: Apache-2.0
#include "fusion/team_graph.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

#include "fusion/matching/team_consistency.hpp"

namespace cairn {
namespace {

using peers::RobotId;
using Poses = std::map<RobotId, SE3>;

constexpr int kIterations = 10;

/// An order that does not depend on who heard of which claim first.
bool before(const PairClaim& x, const PairClaim& y) {
  const auto key = [](const PairClaim& c) {
    const Vector6 T = c.T_a_b.mean.log();
    return std::tuple(-c.probability, c.a, c.b, T[0], T[1], T[2], T[3], T[4], T[5]);
  };
  return key(x) < key(y);
}

/// As many claims as are looked at together: first the surest that connect the most robots, then the surest others.
std::vector<std::size_t> chosen(std::span<const PairClaim> claims, const std::vector<std::size_t>& order) {
  std::map<RobotId, RobotId> group;
  for (const PairClaim& c : claims) group[c.a] = c.a, group[c.b] = c.b;
  std::vector<std::size_t> connecting, others;
  for (const std::size_t i : order) {
    const RobotId a = group[claims[i].a], b = group[claims[i].b];
    (a == b ? others : connecting).push_back(i);
    for (auto& [robot, of] : group)
      if (of == b) of = a;
  }
  connecting.insert(connecting.end(), others.begin(), others.end());
  connecting.resize(std::min(connecting.size(), matching::kMostClaims));
  return connecting;
}

std::vector<bool> kept(std::span<const PairClaim> claims) {
  std::vector<std::size_t> order(claims.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t i, std::size_t k) { return before(claims[i], claims[k]); });
  const auto looked_at = chosen(claims, order);
  std::vector<RobotId> robots;
  for (const PairClaim& c : claims) robots.insert(robots.end(), {c.a, c.b});
  std::ranges::sort(robots);
  const auto index = [&](RobotId robot) {
    return static_cast<int>(std::ranges::lower_bound(robots, robot) - robots.begin());
  };
  std::vector<matching::Claim> all;
  for (const std::size_t i : looked_at)
    all.push_back({index(claims[i].a), index(claims[i].b), claims[i].T_a_b, claims[i].probability});
  const auto agreement = matching::agreement_of(all);
  std::vector<bool> kept(claims.size(), false);
  for (std::size_t k = 0; k < looked_at.size(); ++k) kept[looked_at[k]] = agreement.kept[k];
  return kept;
}

/// The robots connected with `self`, each placed by one chain of claims from the lowest of them.
Poses chained(RobotId self, std::span<const PairClaim> claims) {
  std::set<RobotId> team{self};
  for (std::size_t size = 0; size != team.size();) {
    size = team.size();
    for (const PairClaim& c : claims)
      if (team.contains(c.a) || team.contains(c.b)) team.insert({c.a, c.b});
  }
  Poses poses{{*team.begin(), SE3()}};
  while (poses.size() < team.size())
    for (const PairClaim& c : claims) {
      const auto a = poses.find(c.a), b = poses.find(c.b);
      if (a != poses.end() && b == poses.end()) poses.emplace(c.b, a->second * c.T_a_b.mean);
      if (a == poses.end() && b != poses.end()) poses.emplace(c.a, b->second * c.T_a_b.mean.inverse());
    }
  return poses;
}

/// One step of Gauss–Newton; residual log(T_a_b⁻¹ T_a⁻¹ T_b), right perturbations.
void refine(Poses& poses, std::span<const PairClaim> claims) {
  std::map<RobotId, Eigen::Index> at;  // the anchor, which is fixed, is not in it
  for (auto pose = std::next(poses.begin()); pose != poses.end(); ++pose)
    at.emplace(pose->first, 6 * static_cast<Eigen::Index>(at.size()));
  const auto size = 6 * static_cast<Eigen::Index>(at.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(size);
  for (const PairClaim& c : claims) {
    if (!poses.contains(c.a)) continue;
    const SE3 T_ab = poses.at(c.a).inverse() * poses.at(c.b);
    const Vector6 r = (c.T_a_b.mean.inverse() * T_ab).log();
    const Matrix6 J_b = right_jacobian_inverse(r), J_a = -J_b * T_ab.inverse().adjoint();
    const Matrix6 information = c.T_a_b.covariance.inverse();
    const std::array<std::pair<RobotId, const Matrix6*>, 2> ends{{{c.a, &J_a}, {c.b, &J_b}}};
    for (const auto& [i, J_i] : ends) {
      if (!at.contains(i)) continue;
      g.segment<6>(at[i]) += J_i->transpose() * information * r;
      for (const auto& [k, J_k] : ends)
        if (at.contains(k)) H.block<6, 6>(at[i], at[k]) += J_i->transpose() * information * *J_k;
    }
  }
  const Eigen::VectorXd step = H.ldlt().solve(-g);
  if (!step.allFinite()) return;
  for (const auto& [robot, first] : at) poses[robot] = poses[robot] * SE3::exp(step.segment<6>(first));
}

SE3 rounded(const SE3& T) {
  Vector6 xi;
  xi << T.translation(), SE3(T.quaternion(), Eigen::Vector3d::Zero()).log().tail<3>();
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double steps = i < 3 ? 4096.0 : 65536.0;
    xi[i] = std::round(xi[i] * steps) / steps;
  }
  Vector6 turn = Vector6::Zero();
  turn.tail<3>() = xi.tail<3>();
  return {SE3::exp(turn).quaternion(), xi.head<3>()};
}

}  // namespace

TeamPoses team_poses(RobotId self, std::span<const PairClaim> claims) {
  TeamPoses team;
  team.kept = kept(claims);
  std::vector<PairClaim> agreeing;
  for (std::size_t i = 0; i < claims.size(); ++i)
    if (team.kept[i]) agreeing.push_back(claims[i]);
  std::ranges::sort(agreeing, before);
  team.T_team_odom = chained(self, agreeing);
  team.anchor = team.T_team_odom.begin()->first;
  if (team.T_team_odom.size() > 1)
    for (int i = 0; i < kIterations; ++i) refine(team.T_team_odom, agreeing);
  for (auto& [robot, T] : team.T_team_odom) T = rounded(T);
  return team;
}

}  // namespace cairn
