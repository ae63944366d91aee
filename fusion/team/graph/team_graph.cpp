// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/graph/team_graph.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "fusion/matching/belief/team_consistency.hpp"
#include "fusion/team/graph/refined_claims.hpp"

namespace cairn::team {
namespace {

using peers::RobotId;
using Poses = std::map<RobotId, SE3>;

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

SE3 rounded(const SE3& T, double steps_per_m, double steps_per_rad) {
  Vector6 xi;
  xi << T.translation(), SE3(T.quaternion(), Eigen::Vector3d::Zero()).log().tail<3>();
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double steps = i < 3 ? steps_per_m : steps_per_rad;
    xi[i] = std::round(xi[i] * steps) / steps;
  }
  Vector6 turn = Vector6::Zero();
  turn.tail<3>() = xi.tail<3>();
  return {SE3::exp(turn).quaternion(), xi.head<3>()};
}

/// The claim as one about the robots' first submaps, by their odometry.
PairClaim about_the_first(const SubmapChains& chains, const PairClaim& claim) {
  PairClaim first = claim;
  if (claim.submap_b != 0) first.T_a_b = compose(first.T_a_b, motion(chains, claim.b, claim.submap_b, 0));
  if (claim.submap_a != 0) first.T_a_b = compose(motion(chains, claim.a, 0, claim.submap_a), first.T_a_b);
  first.submap_a = first.submap_b = 0;
  return first;
}

/// The claims that connect robots, as ones about their first submaps, and where each is in the list of all.
std::pair<std::vector<PairClaim>, std::vector<std::size_t>> connecting(std::span<const PairClaim> claims,
                                                                       const SubmapChains& chains) {
  std::pair<std::vector<PairClaim>, std::vector<std::size_t>> out;
  for (std::size_t i = 0; i < claims.size(); ++i) {
    const PairClaim& c = claims[i];
    if (c.refined || c.submap_a >= submaps_of(chains, c.a) || c.submap_b >= submaps_of(chains, c.b)) continue;
    out.first.push_back(about_the_first(chains, c));
    out.second.push_back(i);
  }
  return out;
}

/// A team's graph while it is being put together.
struct Assembly {
  std::vector<SE3> start;
  std::vector<RelativePose> known;
  SubmapNodes nodes;
};

Assembly with_odometry(const Poses& robots, const SubmapChains& chains) {
  Assembly team;
  for (const auto& [robot, T_team_odom] : robots)
    for (std::size_t k = 0; k < submaps_of(chains, robot); ++k) {
      const std::size_t node = team.start.size();
      team.nodes.emplace(merging::SubmapKey{robot, static_cast<std::uint16_t>(k)}, node);
      team.start.push_back(T_team_odom * place_in_odom(chains, robot, k));
      if (k > 0) team.known.push_back({node - 1, node, motion(chains, robot, k - 1, k)});
    }
  return team;
}

/// `certain`: as certain as they say; whole maps that have drifted fit nowhere exactly.
void add(Assembly& team, std::vector<PairClaim> claims, bool certain) {
  std::ranges::sort(claims, before);
  for (const PairClaim& c : claims) {
    const auto a = team.nodes.find({c.a, c.submap_a}), b = team.nodes.find({c.b, c.submap_b});
    if (a == team.nodes.end() || b == team.nodes.end()) continue;  // another team's
    team.known.push_back({a->second, b->second, certain ? c.T_a_b : matching::bent(c.T_a_b)});
  }
}

std::vector<PairClaim> those(const std::vector<bool>& kept, std::span<const PairClaim> claims, bool refined) {
  std::vector<PairClaim> out;
  for (std::size_t i = 0; i < claims.size(); ++i)
    if (kept[i] && claims[i].refined == refined) out.push_back(claims[i]);
  return out;
}

/// First without what was refined, which must agree with that.
void solve_all(TeamPoses& team, std::span<const PairClaim> claims, const SubmapChains& chains) {
  Assembly assembly = with_odometry(team.T_team_odom, chains);
  add(assembly, those(team.kept, claims, false), assembly.nodes.size() == team.T_team_odom.size());
  team.graph = solve(std::move(assembly.start), assembly.known);
  team.nodes = std::move(assembly.nodes);
  if (std::ranges::none_of(claims, &PairClaim::refined)) return;
  const auto refined = agreeing_refinements(claims, chains, Marginals(team.graph), team.nodes);
  for (std::size_t i = 0; i < claims.size(); ++i) team.kept[i] = team.kept[i] || refined[i];
  assembly.nodes = team.nodes;
  add(assembly, those(refined, claims, true), true);
  team.graph = solve(std::move(team.graph.poses), assembly.known);
}

/// Where the odom frames lie, rounded: first the robots, then what they have drifted since. Robots of which nobody
/// knows how they drifted keep their maps in one piece.
void place(TeamPoses& team, const SubmapChains& chains) {
  const bool several = team.nodes.size() > team.T_team_odom.size();
  SE3 T_team_first, T_team_odom;  // of the robot whose turn it is
  for (const auto& [submap, node] : team.nodes) {
    const SE3& T_team_submap = team.graph.poses[node];
    if (submap.submap == 0) {
      T_team_first = T_team_submap;
      T_team_odom = several ? rounded(T_team_submap, 1 << 5, 1 << 12) : rounded(T_team_submap, 1 << 12, 1 << 16);
      team.submaps[submap] = T_team_odom;
    } else {
      const SE3 T_odom_submap = place_in_odom(chains, submap.robot, submap.submap);
      const SE3 drift = rounded((T_team_first * T_odom_submap).inverse() * T_team_submap, 1 << 5, 1 << 10);
      const bool none = drift.matrix() == Eigen::Matrix4d::Identity();
      team.submaps[submap] = none ? T_team_odom : T_team_odom * T_odom_submap * drift * T_odom_submap.inverse();
    }
    team.T_team_odom[submap.robot] = team.submaps[submap];  // the newest comes last
  }
}

}  // namespace

std::optional<UncertainPose> TeamPoses::between(const merging::SubmapKey& a, const merging::SubmapKey& b) const {
  const auto in_a = nodes.find(a), in_b = nodes.find(b);
  if (in_a == nodes.end() || in_b == nodes.end()) return std::nullopt;
  return Marginals(graph).between(in_a->second, in_b->second);
}

std::optional<SE3> TeamPoses::odom_between(RobotId a, RobotId b) const {
  const auto of_a = T_team_odom.find(a), of_b = T_team_odom.find(b);
  if (of_a == T_team_odom.end() || of_b == T_team_odom.end()) return std::nullopt;
  return of_a->second.inverse() * of_b->second;
}

std::map<std::uint16_t, SE3> TeamPoses::drifts_of(RobotId robot) const {
  std::map<std::uint16_t, SE3> T_first_odom;
  const auto first = submaps.find({robot, 0});
  if (first == submaps.end()) return T_first_odom;
  for (auto submap = std::next(first); submap != submaps.end() && submap->first.robot == robot; ++submap)
    if (submap->second.matrix() != first->second.matrix())
      T_first_odom[submap->first.submap] = first->second.inverse() * submap->second;
  return T_first_odom;
}

TeamPoses team_poses(RobotId self, std::span<const PairClaim> claims, const SubmapChains& chains) {
  TeamPoses team;
  const auto [firsts, at] = connecting(claims, chains);
  const auto agree = kept(firsts);
  team.kept.resize(claims.size(), false);
  std::vector<PairClaim> agreeing;
  for (std::size_t i = 0; i < firsts.size(); ++i) {
    if (!agree[i]) continue;
    team.kept[at[i]] = true;
    agreeing.push_back(firsts[i]);
  }
  std::ranges::sort(agreeing, before);
  team.T_team_odom = chained(self, agreeing);
  team.anchor = team.T_team_odom.begin()->first;
  solve_all(team, claims, chains);
  place(team, chains);
  return team;
}

}  // namespace cairn::team
