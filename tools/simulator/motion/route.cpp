// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/route.hpp"

#include <algorithm>
#include <deque>
#include <numeric>

#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr std::uint64_t kMeetingStream = 1, kStartStream = 2, kRoamStream = 3;

/// Numbers the connected parts of the passable cells from 1; 0 = not passable or not asked for.
class Parts {
 public:
  explicit Parts(const FloorPlan& plan) : plan_(plan), part_(plan.index(0, plan.height()), 0) {}

  /// The part that `p` belongs to.
  int of(const Vector2d& p) {
    const Vector2i at = plan_.cell(p);
    const std::size_t index = plan_.index(at.x(), at.y());
    if (part_[index] == 0 && plan_.cell_clearance(index) >= kPassable) flood(at, ++parts_);
    return part_[index];
  }

 private:
  void flood(const Vector2i& from, int part) {
    std::vector<Vector2i> open{from};
    part_[plan_.index(from.x(), from.y())] = part;
    while (!open.empty()) {
      const Vector2i at = open.back();
      open.pop_back();
      for (const Vector2i& step : {Vector2i(1, 0), Vector2i(-1, 0), Vector2i(0, 1), Vector2i(0, -1)}) {
        const Vector2i next = at + step;  // the rim of the plan is an obstacle, so `next` is inside
        const std::size_t index = plan_.index(next.x(), next.y());
        if (part_[index] != 0 || plan_.cell_clearance(index) < kPassable) continue;
        part_[index] = part;
        open.push_back(next);
      }
    }
  }

  const FloorPlan& plan_;
  std::vector<int> part_;
  int parts_ = 0;
};

/// The largest set of places with room to turn that are connected with each other.
Path connected(const FloorPlan& plan, const Path& places) {
  Parts parts(plan);
  std::vector<Path> groups;
  for (const Vector2d& p : places) {
    if (plan.clearance(p) < kRoomToTurn) continue;
    const auto part = static_cast<std::size_t>(parts.of(p));
    if (groups.size() <= part) groups.resize(part + 1);
    groups[part].push_back(p);
  }
  const auto largest =
      std::max_element(groups.begin(), groups.end(), [](const Path& a, const Path& b) { return a.size() < b.size(); });
  return largest == groups.end() ? Path{} : *largest;
}

}  // namespace

RoutePlanner::RoutePlanner(const World& world, const FloorPlan& plan, std::uint64_t seed)
    : plan_(plan), seed_(seed), places_(connected(plan, world.places)) {
  if (!places_.empty()) meeting_ = Random(seed, kMeetingStream).below(places_.size());
}

std::vector<std::size_t> RoutePlanner::starts(int robots) const {
  constexpr double kNearest = 4.0, kFarthest = 16.0, kApart = 3.0;
  std::vector<std::size_t> order(places_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Random random(seed_, kStartStream);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  std::erase(order, meeting_);
  std::vector<std::size_t> chosen;
  const auto good = [&](std::size_t place) {
    const double distance = (places_[place] - places_[meeting_]).norm();
    return distance >= kNearest && distance <= kFarthest &&
           std::all_of(chosen.begin(), chosen.end(),
                       [&](std::size_t other) { return (places_[place] - places_[other]).norm() >= kApart; });
  };
  while (static_cast<int>(chosen.size()) < robots) {
    auto next = std::find_if(order.begin(), order.end(), good);
    if (next == order.end()) next = order.begin();
    chosen.push_back(*next);
    order.erase(next);
  }
  return chosen;
}

Path RoutePlanner::roam(std::size_t start, std::uint64_t robot, double length) const {
  constexpr double kNearest = 3.0, kFarthest = 22.0;
  constexpr std::size_t kRemembered = 4;
  Random random(seed_, kRoamStream, robot);
  Path path{places_[start]};
  std::deque<std::size_t> visited{start};
  double driven = 0;
  for (std::size_t goal = meeting_; driven < length;) {
    if (const auto leg = find_path(plan_, path.back(), places_[goal])) {
      // Leg by leg, so that a dead end is driven to its end: where the robot turns is chosen for turning.
      const Path even = smooth(plan_, *leg);
      path.insert(path.end(), even.begin() + 1, even.end());
      driven += path_length(even);
    }
    visited.push_back(goal);
    if (visited.size() > std::min(kRemembered, places_.size() - 2)) visited.pop_front();
    for (int tries = 0; tries < 200; ++tries) {
      goal = random.below(places_.size());
      const double away = (places_[goal] - path.back()).norm();
      const bool seen = std::find(visited.begin(), visited.end(), goal) != visited.end();
      if (!seen && away >= kNearest && away <= kFarthest) break;
    }
  }
  return path;
}

Result<std::vector<Path>> RoutePlanner::plan(int robots, double length) const {
  if (static_cast<int>(places_.size()) < robots + 2) {
    return Error{Errc::kLimit,
                 "too many robots for this scene",
                 "simulator",
                 {},
                 "there is room for " + std::to_string(std::max(0, static_cast<int>(places_.size()) - 2))};
  }
  std::vector<Path> paths;
  std::uint64_t robot = 0;
  for (const std::size_t start : starts(robots)) paths.push_back(roam(start, robot++, length));
  return paths;
}

}  // namespace cairn::simulator
