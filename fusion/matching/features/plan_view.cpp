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
constexpr float kUnclearWeight = 0.5F;  // of a surfel that is neither upright nor level, as a wall
constexpr float kRim_columns = 1.5F;    // around the surfels
constexpr int kRims_columns = 4;        // both rims, rounded up
constexpr int kDegrees = 180;           // of the half circle of directions
constexpr int kBlur_deg = 3;            // half width of the triangle that smooths the directions
constexpr double kDegree_rad = M_PI / 180;
constexpr float kFar_m = 1e9F;  // beyond every map

}  // namespace

PlanView::PlanView(std::span<const Surfel> surfels, const mapping::SemanticOcTree& map, const SE3& turn)
    : turn_(turn.rotation().cast<float>()) {
  lay_out(surfels);
  std::vector<Walls> walls = walls_of(surfels);
  if (map.getRoot() != nullptr)
    add_room(map.getRoot(), Eigen::Vector3i::Constant(-kKeyOrigin), 2 * kKeyOrigin, map, walls);
  for (int y = 0; y < size_.y(); ++y)
    for (int x = 0; x < size_.x(); ++x)
      if (const Column c = column_of(walls[slot({x, y})], x, y); c.mass > 0 || c.open > 0) columns_.push_back(c);
  stack_heights(surfels);
  look_around(surfels);
  measure();
}

std::vector<PlanView::Walls> PlanView::walls_of(std::span<const Surfel> surfels) const {
  std::vector<Walls> walls(slot({0, size_.y()}));
  for (const Surfel& s : surfels) {
    if (s.level()) continue;
    Walls& w = walls[slot(cell_of(s.point.head<2>()))];
    const float weight = s.upright() ? 1 : kUnclearWeight;
    w.count += weight;
    w.at += weight * s.point.head<2>();
    if (s.oriented && s.upright()) w.facing += s.normal.head<2>().normalized();
  }
  return walls;
}

PlanView::Column PlanView::column_of(const Walls& w, int x, int y) const {
  Column c;
  c.mass = std::sqrt(std::min(1.0F, w.count / kFullWall_surfels));
  c.at = w.count > 0 ? Eigen::Vector2f(w.at / w.count)
                     : Eigen::Vector2f(corner_ + cell_m_ * Eigen::Vector2f(float(x) + 0.5F, float(y) + 0.5F));
  if (w.count > 0) c.facing = c.mass / w.count * w.facing;
  if (w.count < 1) c.open = std::min(1.0F, w.room_m3 / (kFullRoom_m * cell_m_ * cell_m_));
  return c;
}

void PlanView::lay_out(std::span<const Surfel> surfels) {
  Eigen::Vector2f low = Eigen::Vector2f::Zero(), high = low;
  if (!surfels.empty()) low = high = surfels.front().point.head<2>();
  for (const Surfel& s : surfels) {
    low = low.cwiseMin(s.point.head<2>());
    high = high.cwiseMax(s.point.head<2>());
  }
  cell_m_ = std::max(cell_m_, (high - low).maxCoeff() / (kMost_columns - kRims_columns));
  corner_ = low - Eigen::Vector2f::Constant(kRim_columns * cell_m_);
  size_ = cell_of(high) + Eigen::Vector2i::Constant(2);
}

/// Adds the space that was observed free, in m³, to the columns in which it lies.
// NOLINTNEXTLINE(misc-no-recursion): as deep as the tree
void PlanView::add_room(const mapping::SemanticNode* node, const Eigen::Vector3i& first, int edge,
                        const mapping::SemanticOcTree& map, std::vector<Walls>& walls) const {
  if (!node->present()) return;
  if (node->block() != nullptr) {
    for (int i = 0; i < 8; ++i)
      add_room(node->block() + i, first + edge / 2 * Eigen::Vector3i(i & 1, i >> 1 & 1, i >> 2), edge / 2, map, walls);
    return;
  }
  if (node->getLogOdds() >= map.getOccupancyThresLog()) return;
  const auto voxel = static_cast<float>(map.getResolution());
  const float width = static_cast<float>(edge) * voxel;
  const Eigen::Vector3f centre = (first.cast<float>().array() + 0.5F * static_cast<float>(edge)) * voxel;
  const Eigen::Vector2f middle = turn_.topRows<2>() * centre;
  if (edge == 1) {  // nearly all
    const Eigen::Vector2i cell = cell_of(middle);
    if (cell.minCoeff() >= 0 && (cell.array() < size_.array()).all())
      walls[slot(cell)].room_m3 += std::min(width * width, cell_m_ * cell_m_) * width;
    return;
  }
  const Eigen::Vector2f corner = middle - Eigen::Vector2f::Constant(0.5F * width);
  const Eigen::Vector2f inner = Eigen::Vector2f::Constant(0.5F * std::min(width, voxel));
  const Eigen::Vector2i from = cell_of(corner + inner).cwiseMax(0);
  const Eigen::Vector2i to = cell_of(corner - inner + Eigen::Vector2f::Constant(width))
                                 .cwiseMin(size_.array().matrix() - Eigen::Vector2i::Ones());
  if ((to.array() < from.array()).any()) return;
  const float area =
      std::min(width * width, cell_m_ * cell_m_ * float(to.x() - from.x() + 1) * float(to.y() - from.y() + 1));
  const float each = area * width / (float(to.x() - from.x() + 1) * float(to.y() - from.y() + 1));
  for (int y = from.y(); y <= to.y(); ++y)
    for (int x = from.x(); x <= to.x(); ++x) walls[slot({x, y})].room_m3 += each;
}

void PlanView::stack_heights(std::span<const Surfel> surfels) {
  starts_.assign(slot({0, size_.y()}) + 1, 0);
  for (const Surfel& s : surfels) ++starts_[slot(cell_of(s.point.head<2>())) + 1];
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  heights_.resize(surfels.size());
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  if (!surfels.empty()) bottom_ = top_ = surfels.front().point.z();
  for (const Surfel& s : surfels) {
    heights_[next[slot(cell_of(s.point.head<2>()))]++] = {s.point.z(), s.level()};
    bottom_ = std::min(bottom_, s.point.z());
    top_ = std::max(top_, s.point.z());
  }
}

std::span<const PlanView::Height> PlanView::heights(const Eigen::Vector2f& at) const {
  const Eigen::Vector2f cells = (at - corner_) / cell_m_;
  if (!(cells.minCoeff() >= 0 && cells.x() < float(size_.x()) && cells.y() < float(size_.y()))) return {};
  const std::size_t i = slot(cells.cast<int>());
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
