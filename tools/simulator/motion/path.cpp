// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

namespace cairn::simulator {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

/// What a metre costs: dear near obstacles, 1 from `kComfort` on.
double cost_per_metre(double clearance) {
  constexpr double kComfort = 1.1, kFear = 6.0;
  const double lack = std::max(0.0, kComfort - clearance);
  return 1.0 + kFear * lack * lack;
}

struct Open {
  double estimate;
  std::size_t cell;
  // Ties go to the lower cell, so that the path is the same everywhere.
  bool operator<(const Open& other) const {
    return estimate != other.estimate ? estimate > other.estimate : cell > other.cell;
  }
};

class Search {
 public:
  explicit Search(const FloorPlan& plan)
      : plan_(plan), cost_(plan.index(0, plan.height()), kInfinity), parent_(cost_.size(), 0) {}

  bool run(const Vector2i& from, const Vector2i& to) {
    goal_ = to;
    const std::size_t start = plan_.index(from.x(), from.y()), target = plan_.index(to.x(), to.y());
    cost_[start] = 0;
    parent_[start] = start;
    open_.push({0, start});
    while (!open_.empty()) {
      const Open best = open_.top();
      open_.pop();
      if (best.cell == target) return true;
      expand(best);
    }
    return false;
  }

  [[nodiscard]] Path way_to(const Vector2i& to) const {
    Path path;
    for (std::size_t at = plan_.index(to.x(), to.y());; at = parent_[at]) {
      const Vector2i c = cell(at);
      path.push_back(plan_.centre(c.x(), c.y()));
      if (parent_[at] == at) break;
    }
    std::reverse(path.begin(), path.end());
    return path;
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  [[nodiscard]] Vector2i cell(std::size_t index) const {
    const auto width = static_cast<std::size_t>(plan_.width());
    return {static_cast<int>(index % width), static_cast<int>(index / width)};
  }

  void expand(const Open& from) {
    const Vector2i at = cell(from.cell);
    const double cost = cost_[from.cell];
    if (from.estimate > cost + heuristic(at) + 1e-9) return;  // a better way was found since
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) {
        const Vector2i next(at.x() + di, at.y() + dj);
        if (next.x() < 0 || next.y() < 0 || next.x() >= plan_.width() || next.y() >= plan_.height()) continue;
        const std::size_t index = plan_.index(next.x(), next.y());
        const double clearance = plan_.cell_clearance(index);
        if (clearance < kPassable) continue;
        const double step = FloorPlan::kCell * std::hypot(di, dj) * cost_per_metre(clearance);
        if (cost + step >= cost_[index]) continue;
        cost_[index] = cost + step;
        parent_[index] = from.cell;
        open_.push({cost_[index] + heuristic(next), index});
      }
    }
  }

  [[nodiscard]] double heuristic(const Vector2i& at) const {
    return FloorPlan::kCell * (goal_ - at).cast<double>().norm();
  }

  const FloorPlan& plan_;
  Vector2i goal_{0, 0};
  std::vector<double> cost_;
  std::vector<std::size_t> parent_;
  std::priority_queue<Open> open_;
};

Path resample(const Path& path, double step) {
  Path out{path.front()};
  double left = step;
  for (std::size_t i = 1; i < path.size(); ++i) {
    Vector2d from = path[i - 1];
    double length = (path[i] - from).norm();
    while (length >= left) {
      from += (path[i] - from) * (left / length);
      length -= left;
      out.push_back(from);
      left = step;
    }
    left -= length;
  }
  return out;
}

}  // namespace

double path_length(const Path& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

std::optional<Path> find_path(const FloorPlan& plan, const Vector2d& from, const Vector2d& to) {
  if (plan.clearance(from) < kPassable || plan.clearance(to) < kPassable) return std::nullopt;
  Search search(plan);
  if (!search.run(plan.cell(from), plan.cell(to))) return std::nullopt;
  Path path = search.way_to(plan.cell(to));
  path.front() = from;
  path.back() = to;
  return path;
}

Path smooth(const FloorPlan& plan, const Path& path) {
  constexpr int kRounds = 300;
  Path points = resample(path, kPathStep);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const Vector2d moved = 0.5 * points[i] + 0.25 * (points[i - 1] + points[i + 1]);
      // A tight spot may not get tighter; elsewhere half a metre beyond the body is enough.
      if (plan.clearance(moved) >= std::min(kRoomToTurn, plan.clearance(points[i]))) points[i] = moved;
    }
  }
  return resample(points, kPathStep);
}

}  // namespace cairn::simulator
