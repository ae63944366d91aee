// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/methods/run_methods.hpp"

#include <cmath>

#include "fusion/matching/book/em.hpp"
#include "fusion/matching/book/methods.hpp"
#include "fusion/matching/book/point_grid.hpp"
#include "hal/clock.hpp"

namespace cairn::protocol {
namespace {

using matching::MapFeatures;
using matching::Matcher;

Result<Attempt> attempt_from(const MapPair& pair, const Matcher& matcher, int start) {
  const SE3 from = start_pose(pair.T_a_b, starts().at(static_cast<std::size_t>(start)));
  Budget budget = Budget::steps(matching::kAmpleSteps);
  const Duration began = thread_cpu_time();
  const auto result = matcher.match(UncertainPose{from, matching::default_prior_covariance()}, budget);
  const double seconds = to_seconds(thread_cpu_time() - began);
  if (!result) return result.error();
  const SE3& T_a_b = result->T_a_b.mean;
  return Attempt{start, T_a_b, error_of(T_a_b, pair.T_a_b), seconds, result->iterations, result->accepted, {}};
}

}  // namespace

std::vector<std::string> our_methods(const MapPair& pair) {
  if (pair.kind == kOverlap) return {"edge_icp", "pmm_level1", "pmm", "default"};
  if (pair.kind == kHeterogeneous || pair.kind == kUnlike) return {"oicp", "em_book", "em", "default"};
  if (pair.kind == kMission) return {"default"};
  return {"oicp", "edge_icp", "pmm_level1", "pmm", "em", "default"};
}

bool has_rms(const MapPair& pair) {
  return pair.kind == kHeterogeneous || pair.kind == kMission || pair.kind == kUnlike;
}

bool is_fast(std::string_view method) { return method == "edge_icp" || method == "pmm_level1" || method == "default"; }

Result<MethodRun> run_method(const MapPair& pair, const std::string& method, int count) {
  MethodRun run;
  run.method = method;
  const Duration began = thread_cpu_time();
  const auto a = MapFeatures::build(*pair.a), b = MapFeatures::build(*pair.b);
  if (!a) return a.error();
  if (!b) return b.error();
  const auto matcher = matching::make_any_matcher(method, *a, *b);
  if (!matcher) return matcher.error();
  run.preparation_s = to_seconds(thread_cpu_time() - began);
  if (const auto* em = dynamic_cast<const matching::Em*>(matcher->get()))
    run.correspondences = em->mean_correspondences();
  std::optional<VoxelDistance> distance;
  if (has_rms(pair)) distance.emplace(pair);
  for (const int start : chosen_starts(count)) {
    auto attempt = attempt_from(pair, **matcher, start);
    if (!attempt) return attempt.error();
    if (distance) attempt->rms_m = distance->rms(attempt->T_a_b);
    run.attempts.push_back(*std::move(attempt));
  }
  return run;
}

struct VoxelDistance::Grids {
  matching::PointGrid a;
  std::vector<Eigen::Vector3f> b;
};

VoxelDistance::VoxelDistance(const MapPair& pair) {
  grids_ = std::make_unique<const Grids>(
      Grids{matching::PointGrid(occupied_centres(*pair.a), static_cast<float>(4 * pair.a->getResolution())),
            occupied_centres(*pair.b)});
}

VoxelDistance::~VoxelDistance() = default;

double VoxelDistance::rms(const SE3& T_a_b) const {
  double squares = 0;
  int pairs = 0;
  for (const Eigen::Vector3f& p : grids_->b) {
    const Eigen::Vector3f at = (T_a_b * p.cast<double>()).cast<float>();
    const int i = grids_->a.nearest(at, kRmsGateM);
    if (i == matching::PointGrid::kNone) continue;
    squares += static_cast<double>((grids_->a.points()[static_cast<std::size_t>(i)] - at).squaredNorm());
    ++pairs;
  }
  return pairs > 0 ? std::sqrt(squares / pairs) : 0;
}

}  // namespace cairn::protocol
