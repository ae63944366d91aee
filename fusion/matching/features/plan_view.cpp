// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/plan_view.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::matching {
namespace {

// All of these are chosen by hand, not tuned.

// In a column, for a mass of 1: two surfels wide and 1.6 m high.
constexpr float kFullWall_surfels = 16;
// Height of a column that was observed free, for an openness of 1.
constexpr float kFullRoom_m = 0.8F;
constexpr float kWalled_surfels = 1;    // of upright ones, in a column that is not open
constexpr float kUnclearWeight = 0.5F;  // of a surfel that is neither upright nor level, as a wall
constexpr float kRim_columns = 1.5F;    // around the surfels
constexpr int kRims_columns = 4;        // both rims, rounded up
constexpr int kDegrees = 180;           // of the half circle of directions
constexpr int kBlur_deg = 3;            // half width of the triangle that smooths the directions
constexpr double kDegree_rad = M_PI / 180;
constexpr float kFar_m = 1e9F;  // beyond every map

}  // namespace

PlanView::PlanView(std::span<const Surfel> surfels, const mapping::SemanticOcTree& map, const SE3& turn) {
  lay_out(surfels);
  const std::vector<Walls> walls = walls_of(surfels);
  const std::vector<float> room_m3 = room_of(map, turn.rotation().cast<float>(), walls);
  for (int y = 0; y < grid_.size.y(); ++y)
    for (int x = 0; x < grid_.size.x(); ++x) {
      const std::size_t i = grid_.slot({x, y});
      if (const Column c = column_of(walls[i], room_m3[i], x, y); c.mass > 0 || c.open > 0) columns_.push_back(c);
    }
  stack_heights(surfels);
  look_around(surfels);
  measure();
}

std::vector<PlanView::Walls> PlanView::walls_of(std::span<const Surfel> surfels) const {
  std::vector<Walls> walls(grid_.count());
  for (const Surfel& s : surfels) {
    if (s.level()) continue;
    Walls& w = walls[grid_.slot(grid_.cell_of(s.point.head<2>()))];
    const float weight = s.upright() ? 1 : kUnclearWeight;
    w.count += weight;
    w.at += weight * s.point.head<2>();
    if (s.oriented && s.upright()) w.facing += s.normal.head<2>().normalized();
  }
  return walls;
}

float PlanView::full_room_m3() const { return kFullRoom_m * grid_.cell_m * grid_.cell_m; }

std::vector<float> PlanView::room_of(const mapping::SemanticOcTree& map, const Eigen::Matrix3f& turn,
                                     const std::vector<Walls>& walls) const {
  std::vector<float> room_m3(walls.size(), 0.0F);
  for (std::size_t i = 0; i < walls.size(); ++i)
    if (walls[i].count >= kWalled_surfels) room_m3[i] = full_room_m3();
  add_room(map, turn, grid_, full_room_m3(), room_m3);
  return room_m3;
}

PlanView::Column PlanView::column_of(const Walls& w, float room_m3, int x, int y) const {
  Column c;
  c.mass = std::sqrt(std::min(1.0F, w.count / kFullWall_surfels));
  c.at = w.count > 0 ? Eigen::Vector2f(w.at / w.count)
                     : Eigen::Vector2f(grid_.corner + grid_.cell_m * Eigen::Vector2f(float(x) + 0.5F, float(y) + 0.5F));
  if (w.count > 0) c.facing = c.mass / w.count * w.facing;
  if (w.count < kWalled_surfels) c.open = std::min(1.0F, room_m3 / full_room_m3());
  return c;
}

void PlanView::lay_out(std::span<const Surfel> surfels) {
  Eigen::Vector2f low = Eigen::Vector2f::Zero(), high = low;
  if (!surfels.empty()) low = high = surfels.front().point.head<2>();
  for (const Surfel& s : surfels) {
    low = low.cwiseMin(s.point.head<2>());
    high = high.cwiseMax(s.point.head<2>());
  }
  grid_.cell_m = std::max(grid_.cell_m, (high - low).maxCoeff() / (kMost_columns - kRims_columns));
  grid_.corner = low - Eigen::Vector2f::Constant(kRim_columns * grid_.cell_m);
  grid_.size = grid_.cell_of(high) + Eigen::Vector2i::Constant(2);
}

void PlanView::stack_heights(std::span<const Surfel> surfels) {
  starts_.assign(grid_.count() + 1, 0);
  for (const Surfel& s : surfels) ++starts_[grid_.slot(grid_.cell_of(s.point.head<2>())) + 1];
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  heights_.resize(surfels.size());
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  if (!surfels.empty()) bottom_ = top_ = surfels.front().point.z();
  for (const Surfel& s : surfels) {
    heights_[next[grid_.slot(grid_.cell_of(s.point.head<2>()))]++] = {s.point.z(), s.level()};
    bottom_ = std::min(bottom_, s.point.z());
    top_ = std::max(top_, s.point.z());
  }
}

std::span<const PlanView::Height> PlanView::heights(const Eigen::Vector2f& at) const {
  const Eigen::Vector2f cells = (at - grid_.corner) / grid_.cell_m;
  if (!(cells.minCoeff() >= 0 && cells.x() < float(grid_.size.x()) && cells.y() < float(grid_.size.y()))) return {};
  const std::size_t i = grid_.slot(cells.cast<int>());
  return std::span(heights_).subspan(starts_[i], starts_[i + 1] - starts_[i]);
}

void PlanView::look_around(std::span<const Surfel> surfels) {
  std::vector<float> counts(kDegrees, 0.0F);
  for (const Surfel& s : surfels) {
    if (!s.upright()) continue;
    const double degrees =
        std::atan2(static_cast<double>(s.normal.y()), static_cast<double>(s.normal.x())) / kDegree_rad;
    counts[static_cast<std::size_t>(static_cast<int>(std::floor(degrees)) + 2 * kDegrees) % kDegrees] += 1;
  }
  directions_.assign(kDegrees, 0.0F);
  for (int i = 0; i < kDegrees; ++i)
    for (int d = -kBlur_deg; d <= kBlur_deg; ++d)
      directions_[static_cast<std::size_t>(i)] += counts[static_cast<std::size_t>((i + d + kDegrees) % kDegrees)] *
                                                  static_cast<float>(kBlur_deg + 1 - std::abs(d));
}

void PlanView::measure() {
  Eigen::Vector2f sum = Eigen::Vector2f::Zero();
  float mass = 0;
  low_ = Eigen::Vector2f::Constant(kFar_m);
  high_ = -low_;
  for (const Column& c : columns_) {
    if (c.mass == 0) continue;
    sum += c.mass * c.at;
    mass += c.mass;
    low_ = low_.cwiseMin(c.at);
    high_ = high_.cwiseMax(c.at);
  }
  if (mass == 0) low_ = high_ = middle_;
  if (mass > 0) middle_ = sum / mass;
  for (const Column& c : columns_)
    if (c.mass > 0) radius_ = std::max(radius_, (c.at - middle_).norm());
}

}  // namespace cairn::matching
