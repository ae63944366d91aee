// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "fusion/team/comparisons/compared_peers.hpp"
#include "fusion/team/comparisons/match_job.hpp"
#include "fusion/team/comparisons/match_worth.hpp"
#include "fusion/team/comparisons/team_view.hpp"
#include "hal/time.hpp"

namespace cairn::team {

/// Which two maps are compared next. One comparison is out at a time.
class MatchPlan {
 public:
  /// `least_tiles`: that both maps must have with something occupied.
  MatchPlan(const MatchWorthConfig& config, std::size_t least_tiles) : config_(config), least_tiles_(least_tiles) {}

  /// The comparison that is most worth its time now: of whole maps with a peer of a higher id, else of
  /// two submaps of robots that are in the team. Nothing if none is, or while one is out.
  [[nodiscard]] std::optional<MatchJob> next(const TeamView& team, ComparedPeers& compared, Time now);
  /// The job that is out has come back.
  void done() { out_ = false; }

 private:
  [[nodiscard]] std::optional<MatchJob> of_whole_maps(const TeamView& team, ComparedPeers& compared, Time now) const;
  [[nodiscard]] std::optional<MatchJob> of_submaps(const TeamView& team, ComparedPeers& compared, Time now) const;

  MatchWorthConfig config_;
  std::size_t least_tiles_;
  bool out_ = false;
};

}  // namespace cairn::team
