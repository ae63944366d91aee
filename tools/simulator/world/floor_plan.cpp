// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/floor_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cairn::simulator {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Polygon = std::vector<Vector3d>;

/// Sutherland–Hodgman against one horizontal plane: what lies above it (sign +1) or below it (−1) stays.
Polygon clip(const Polygon& in, double z, double sign) {
  Polygon out;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const Vector3d &p = in[i], &q = in[(i + 1) % in.size()];
    const double dp = sign * (p.z() - z), dq = sign * (q.z() - z);
    if (dp >= 0) out.push_back(p);
    if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) out.push_back(p + (q - p) * (dp / (dp - dq)));
  }
  return out;
}

/// Separating axes of a convex polygon's shadow and a square cell; the cell's own axes are done by the caller's loop.
bool touches(const Polygon& polygon, const Vector2d& centre, double half) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d edge = (polygon[(i + 1) % polygon.size()] - polygon[i]).head<2>();
    const Vector2d normal(-edge.y(), edge.x());
    const double reach = half * (std::abs(normal.x()) + std::abs(normal.y()));
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vector3d& p : polygon) {
      const double d = normal.dot(p.head<2>() - centre);
      low = std::min(low, d);
      high = std::max(high, d);
    }
    if (low > reach || high < -reach) return false;
  }
  return true;
}

/// Squared distance transform of one line (Felzenszwalb, Huttenlocher, "Distance Transforms of Sampled Functions").
void transform_line(std::vector<double>& f, std::vector<int>& v, std::vector<double>& z, std::vector<double>& d) {
  const int n = static_cast<int>(f.size());
  const auto at = [](auto& a, int i) -> auto& { return a[static_cast<std::size_t>(i)]; };
  const double inf = std::numeric_limits<double>::infinity();
  int k = 0;
  at(v, 0) = 0;
  at(z, 0) = -inf;
  at(z, 1) = inf;
  const auto meet = [&](int q, int p) {
    return ((at(f, q) + static_cast<double>(q) * q) - (at(f, p) + static_cast<double>(p) * p)) / (2.0 * (q - p));
  };
  for (int q = 1; q < n; ++q) {
    double s = meet(q, at(v, k));
    while (k > 0 && s <= at(z, k)) s = meet(q, at(v, --k));
    at(v, ++k) = q;
    at(z, k) = s;
    at(z, k + 1) = inf;
  }
  k = 0;
  for (int q = 0; q < n; ++q) {
    while (at(z, k + 1) < q) ++k;
    const double step = q - at(v, k);
    at(d, q) = step * step + at(f, at(v, k));
  }
  f = d;
}

}  // namespace

FloorPlan::FloorPlan(const World& world, const ObstacleBand& band)
    : band_(band),
      origin_(world.bounds.min().head<2>()),
      width_(static_cast<int>(std::ceil(world.bounds.sizes().x() / kCell))),
      height_(static_cast<int>(std::ceil(world.bounds.sizes().y() / kCell))) {
  std::vector<bool> obstacle(index(0, height_));
  for (const Triangle& t : world.mesh.triangles()) {
    if (t.material != Material::kSoil) mark(world, t, obstacle);
  }
  for (int i = 0; i < width_; ++i) obstacle[index(i, 0)] = obstacle[index(i, height_ - 1)] = true;
  for (int j = 0; j < height_; ++j) obstacle[index(0, j)] = obstacle[index(width_ - 1, j)] = true;
  measure(obstacle);
}

Eigen::Vector2i FloorPlan::cell(const Vector2d& p) const {
  const Vector2d at = (p - origin_) / kCell;
  return {std::clamp(static_cast<int>(std::floor(at.x())), 0, width_ - 1),
          std::clamp(static_cast<int>(std::floor(at.y())), 0, height_ - 1)};
}

void FloorPlan::mark(const World& world, const Triangle& t, std::vector<bool>& obstacle) const {
  Polygon polygon{t.a.cast<double>(), t.b.cast<double>(), t.c.cast<double>()};
  const Vector3d middle = (polygon[0] + polygon[1] + polygon[2]) / 3.0;
  const double ground = world.ground(middle.x(), middle.y());
  polygon = clip(clip(polygon, ground + band_.low, 1), ground + band_.high, -1);
  if (polygon.empty()) return;
  Eigen::AlignedBox2d box;
  for (const Vector3d& p : polygon) box.extend(p.head<2>());
  const Eigen::Vector2i low = cell(box.min()), high = cell(box.max());
  for (int j = low.y(); j <= high.y(); ++j) {
    for (int i = low.x(); i <= high.x(); ++i) {
      if (touches(polygon, centre(i, j), 0.5 * kCell)) obstacle[index(i, j)] = true;
    }
  }
}

void FloorPlan::measure(const std::vector<bool>& obstacle) {
  constexpr double kFar = 1e12;  // not infinity: the parabolas' intersections must stay finite
  std::vector<double> squared(obstacle.size());
  for (std::size_t i = 0; i < obstacle.size(); ++i) squared[i] = obstacle[i] ? 0.0 : kFar;
  const auto n = static_cast<std::size_t>(std::max(width_, height_));
  std::vector<int> v(n);
  std::vector<double> z(n + 1), d, line;
  const auto along = [&](int lines, int length, auto&& cell_index) {
    line.resize(static_cast<std::size_t>(length));
    d.resize(line.size());
    for (int l = 0; l < lines; ++l) {
      for (int k = 0; k < length; ++k) line[static_cast<std::size_t>(k)] = squared[cell_index(l, k)];
      transform_line(line, v, z, d);
      for (int k = 0; k < length; ++k) squared[cell_index(l, k)] = line[static_cast<std::size_t>(k)];
    }
  };
  along(width_, height_, [this](int l, int k) { return index(l, k); });
  along(height_, width_, [this](int l, int k) { return index(k, l); });
  clearance_.resize(squared.size());
  for (std::size_t i = 0; i < squared.size(); ++i) clearance_[i] = static_cast<float>(kCell * std::sqrt(squared[i]));
}

double FloorPlan::clearance(const Vector2d& p) const {
  const Vector2d at = (p - origin_) / kCell - Vector2d(0.5, 0.5);
  const int i = static_cast<int>(std::floor(at.x())), j = static_cast<int>(std::floor(at.y()));
  if (i < 0 || j < 0 || i + 1 >= width_ || j + 1 >= height_) return 0;
  const double u = at.x() - i, w = at.y() - j;
  return (1 - w) * ((1 - u) * cell_clearance(index(i, j)) + u * cell_clearance(index(i + 1, j))) +
         w * ((1 - u) * cell_clearance(index(i, j + 1)) + u * cell_clearance(index(i + 1, j + 1)));
}

double FloorPlan::body_clearance(double x, double y, double yaw) const {
  const Placement body{x, y, 0, yaw};
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](double forward, double left) {
    least = std::min(least, clearance((body * Vector3d(forward, left, 0)).head<2>()));
  };
  constexpr int kSteps = 8;
  for (int k = 0; k <= kSteps; ++k) {
    const double u = static_cast<double>(k) / kSteps - 0.5;
    for (const double side : {-0.5, 0.5}) {
      look(u * Body::kLength, side * Body::kWidth);
      look(side * Body::kLength, u * Body::kWidth);
    }
  }
  return least;
}

}  // namespace cairn::simulator
