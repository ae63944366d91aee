// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/live_stage.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tools/simulator/motion/route.hpp"
#include "tools/simulator/scenes/make_world.hpp"

namespace cairn::simulator {
namespace {

constexpr double kShortWay = 2.0;  // m: enough of a path to know its direction

Result<GroundPose> start_of_route(const RoutePlanner& planner) {
  const auto paths = planner.plan(1, kShortWay);
  if (!paths) return paths.error();
  const Path& path = paths->front();
  constexpr std::size_t kAhead = 6;  // points, as drive() looks ahead
  const Eigen::Vector2d from = path.front(), ahead = path[std::min(kAhead, path.size() - 1)] - from;
  return GroundPose{from.x(), from.y(), std::atan2(ahead.y(), ahead.x())};
}

Error no_room(const RoutePlanner& planner, const GroundPose& at) {
  const Eigen::Vector2d wanted(at.x, at.y);
  const auto free = std::ranges::min_element(
      planner.places(), {}, [&](const Eigen::Vector2d& place) { return (place - wanted).squaredNorm(); });
  char where[64], remedy[64] = "choose another --start";
  std::snprintf(where, sizeof where, "--start %g,%g,%g", at.x, at.y, at.yaw);
  if (free != planner.places().end())
    std::snprintf(remedy, sizeof remedy, "there is room at --start %.1f,%.1f,0", free->x(), free->y());
  return {Errc::kInvalidConfig, "the robot has no room there", where, {}, remedy};
}

}  // namespace

Result<LiveStage> LiveStage::make(std::string_view scene, std::uint64_t seed, const std::optional<GroundPose>& start) {
  auto world = make_world(scene);
  if (!world) {
    Error error = world.error();
    error.code = Errc::kInvalidConfig;
    return error;
  }
  auto tracer = Tracer::build(world->mesh);
  if (!tracer) return tracer.error();
  FloorPlan plan(*world);
  const RoutePlanner planner(*world, plan, seed);
  const auto at = start ? Result<GroundPose>(*start) : start_of_route(planner);
  if (!at) return at.error();
  if (!(plan.body_clearance(at->x, at->y, at->yaw) > DrivenBody::kNearest)) return no_room(planner, *at);
  const GroundPose stand = *at;
  return LiveStage{std::move(*world), std::move(plan), std::move(*tracer), stand};
}

}  // namespace cairn::simulator
