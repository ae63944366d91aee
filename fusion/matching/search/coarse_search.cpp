// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/coarse_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fusion/matching/search/same_place.hpp"

namespace cairn::matching {
namespace {

// Of the field around a point: beyond, it is below 0.05. By hand, not tuned.
constexpr float kReach_sigmas = 2.5F;
constexpr int kReach_cells = 3;          // the same, rounded up; σ is one cell
constexpr int kMargin_cells = 3;         // around the points, for kReach_cells
constexpr double kMaxHeadings = 1000;    // a finer step would move no point of any map by a cell
constexpr double kRounding = 1e-9;       // of a quotient that should be whole
constexpr float kFarthest_cells = 1e8F;  // what converts to an int safely

int steps(double half_width, double step) { return static_cast<int>(std::ceil(half_width / step - kRounding)); }

/// Scores of all poses of the window.
struct Volume {
  int yaw, xy, z;  // half widths in steps
  double yaw_step;
  std::vector<float> scores;

  [[nodiscard]] int edge() const { return 2 * xy + 1; }
  [[nodiscard]] int layers() const { return 2 * z + 1; }
  [[nodiscard]] std::size_t plane() const {
    return static_cast<std::size_t>(edge()) * static_cast<std::size_t>(edge()) * static_cast<std::size_t>(layers());
  }
  [[nodiscard]] float* heading(int a) { return scores.data() + static_cast<std::size_t>(a + yaw) * plane(); }
};

struct Shift {
  int yaw = 0, x = 0, y = 0, z = 0;
};

SE3 pose(const SE3& initial, const Volume& v, const Shift& s, double cell_m) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(s.yaw * v.yaw_step, Eigen::Vector3d::UnitZ()));
  return SE3(initial.quaternion() * turn, initial.translation() + cell_m * Eigen::Vector3d(s.x, s.y, s.z));
}

void add_rows(const LikelihoodField& field, const Eigen::Vector3i& cell, const Volume& v, float* sums) {
  for (int z = -v.z; z <= v.z; ++z) {
    if (cell.z() + z < 0 || cell.z() + z >= field.size().z()) {
      sums += v.edge() * v.edge();
      continue;
    }
    for (int y = -v.xy; y <= v.xy; ++y, sums += v.edge()) {
      const float* row = field.row(cell.x() - v.xy, cell.y() + y, cell.z() + z);
      for (int x = 0; x < v.edge(); ++x) sums[x] += row[x];
    }
  }
}

void add_heading(const LikelihoodField& field, std::span<const Eigen::Vector3f> points, const SE3& T, const Volume& v,
                 float* sums) {
  const Eigen::Matrix3f R = T.rotation().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  const Eigen::Vector3i low(v.xy, v.xy, -v.z), high = field.size() - low;
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3f q = R * p + t;
    if (q.hasNaN() || !((q / field.cell_m()).cwiseAbs().maxCoeff() < kFarthest_cells)) continue;
    const Eigen::Vector3i cell = field.cell(q);
    if ((cell.array() < low.array()).any() || (cell.array() >= high.array()).any()) continue;
    add_rows(field, cell, v, sums);
  }
}

/// Takes a mode's neighbours out of the volume: the box of whole steps that same_place() spans.
void blank(Volume& v, const Shift& at, double cell_m) {
  const int yaw = std::max(1, static_cast<int>(std::lround(kSamePlace_rad / v.yaw_step)));
  const int xy = std::max(1, static_cast<int>(std::lround(kSamePlace_m / cell_m)));
  const int turn = static_cast<int>(std::lround(2 * M_PI / v.yaw_step));
  for (int a = -v.yaw; a <= v.yaw; ++a) {
    const int apart = std::abs(a - at.yaw);
    if (std::min(apart, std::abs(turn - apart)) > yaw) continue;
    for (int z = 0; z < v.layers(); ++z)
      for (int y = std::max(-v.xy, at.y - xy); y <= std::min(v.xy, at.y + xy); ++y)
        for (int x = std::max(-v.xy, at.x - xy); x <= std::min(v.xy, at.x + xy); ++x)
          v.heading(a)[(z * v.edge() + y + v.xy) * v.edge() + x + v.xy] = -1;
  }
}

Shift shift_of(const Volume& v, std::size_t i) {
  const auto plane = static_cast<std::size_t>(v.edge()) * static_cast<std::size_t>(v.edge());
  const auto in_heading = i % v.plane();
  const auto in_plane = static_cast<int>(in_heading % plane);
  return {.yaw = static_cast<int>(i / v.plane()) - v.yaw,
          .x = in_plane % v.edge() - v.xy,
          .y = in_plane / v.edge() - v.xy,
          .z = static_cast<int>(in_heading / plane) - v.z};
}

}  // namespace

LikelihoodField::LikelihoodField(std::span<const Eigen::Vector3f> points, float cell_m, const SearchWindow& window)
    : cell_m_(cell_m) {
  lay_out(points, window);
  const float unreached = kReach_sigmas * kReach_sigmas;
  values_.assign(index(0, 0, size_.z()), unreached);
  for (const Eigen::Vector3f& p : points) splat(p);
  for (float& v : values_) v = v < unreached ? std::exp(-0.5F * v) : 0.0F;
}

void LikelihoodField::lay_out(std::span<const Eigen::Vector3f> points, const SearchWindow& window) {
  Eigen::Vector3f low = Eigen::Vector3f::Zero(), high = low;
  if (!points.empty()) low = high = points.front();
  for (const Eigen::Vector3f& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (;; cell_m_ *= 2) {
    const int xy = steps(window.xy_m, static_cast<double>(cell_m_)),
              z = steps(window.z_m, static_cast<double>(cell_m_));
    margin_ = Eigen::Vector3i(2 * xy + kMargin_cells, 2 * xy + kMargin_cells, z + kMargin_cells);
    first_ = (low / cell_m_).array().floor().cast<int>().matrix() - margin_;
    size_ = (high / cell_m_).array().floor().cast<int>().matrix() - first_ + margin_ + Eigen::Vector3i::Ones();
    if (size_.cast<double>().prod() <= kMaxCells) return;
  }
}

void LikelihoodField::splat(const Eigen::Vector3f& point) {
  const Eigen::Vector3f scaled = point / cell_m_;
  const Eigen::Vector3i home = scaled.array().floor().cast<int>();
  for (int z = -kReach_cells; z <= kReach_cells; ++z)
    for (int y = -kReach_cells; y <= kReach_cells; ++y) {
      const Eigen::Vector3i start = home + Eigen::Vector3i(-kReach_cells, y, z) - first_;
      float* row = values_.data() + index(start.x(), start.y(), start.z());
      const Eigen::Vector3f d = (home + Eigen::Vector3i(-kReach_cells, y, z)).cast<float>() - scaled;
      const float yz = (d.y() + 0.5F) * (d.y() + 0.5F) + (d.z() + 0.5F) * (d.z() + 0.5F);
      for (int x = 0; x <= 2 * kReach_cells; ++x) {
        const float dx = d.x() + 0.5F + static_cast<float>(x);
        row[x] = std::min(row[x], dx * dx + yz);
      }
    }
}

std::vector<Mode> search(const LikelihoodField& field, std::span<const Eigen::Vector3f> points, const SE3& initial,
                         const SearchWindow& window, int modes) {
  const auto cell_m = static_cast<double>(field.cell_m());
  const double yaw_step = std::max(window.yaw_step_rad, 2 * M_PI / kMaxHeadings);
  const double yaw = std::min(window.yaw_rad, M_PI);
  Volume v{.yaw = steps(yaw, yaw_step),
           .xy = steps(window.xy_m, cell_m),
           .z = steps(window.z_m, cell_m),
           .yaw_step = yaw_step,
           .scores = {}};
  v.scores.assign(static_cast<std::size_t>(2 * v.yaw + 1) * v.plane(), 0.0F);
  for (int a = -v.yaw; a <= v.yaw; ++a)
    add_heading(field, points, pose(initial, v, {.yaw = a}, cell_m), v, v.heading(a));
  std::vector<Mode> best;
  const double n = std::max<double>(1, static_cast<double>(points.size()));
  while (best.size() < static_cast<std::size_t>(modes)) {
    const auto top = std::max_element(v.scores.begin(), v.scores.end());
    if (*top < 0 || (*top == 0 && !best.empty())) break;
    const Shift at = shift_of(v, static_cast<std::size_t>(top - v.scores.begin()));
    best.push_back({pose(initial, v, at, cell_m), static_cast<double>(*top) / n});
    blank(v, at, cell_m);
  }
  return best;
}

}  // namespace cairn::matching
