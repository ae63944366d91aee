// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/cluster_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "onboard/perception/people/body.hpp"

namespace cairn::people {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kWidest = 1.1F;         // m: of somebody who strides
constexpr float kLowestTop = 0.9F;      // m: a child; what is lower is furniture
constexpr float kHighestBottom = 1.0F;  // m: what hangs in the air is no person
constexpr float kSteepest = 0.26F;      // tangent of a VLP-16's highest laser: near people have no heads
constexpr float kHalfBody = 0.12F;      // m from the side that is seen to the middle
constexpr std::uint32_t kFewest = 4;    // points

}  // namespace

struct ClusterFinder::Body {
  Vector2f low = Vector2f::Constant(std::numeric_limits<float>::infinity()), high = -low;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  float bottom = kHead, top = 0;
  std::uint32_t points = 0;

  [[nodiscard]] float extent() const { return (high - low).maxCoeff(); }
  [[nodiscard]] Vector2f middle() const { return (sum / points).cast<float>(); }
};

ClusterFinder::ClusterFinder(double farthest_m)
    : farthest_(static_cast<float>(farthest_m)),
      side_(2 * static_cast<int>(std::ceil(farthest_m / kCell)) + 2),
      ground_(farthest_m),
      head_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), 0) {}

/// A rim of cells stays empty, so that every cell has its neighbours.
void ClusterFinder::fill_cells(std::span<const Vector3f> points, const Vector3f& sensor) {
  std::ranges::fill(head_, 0U);
  filled_.clear();
  heights_.assign(points.size(), 0.0F);
  next_.resize(points.size());
  const auto side = static_cast<float>(side_);
  const Vector2f corner = sensor.head<2>().array() - 0.5F * kCell * side;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Vector2f at = (points[i].head<2>() - corner) / kCell;
    // What is not finite is not within, either.
    if (!(at.array() >= 1).all() || !(at.array() < side - 1).all()) continue;
    if ((points[i].head<2>() - sensor.head<2>()).norm() > farthest_) continue;
    heights_[i] = points[i].z() - ground_.height(points[i].x(), points[i].y());
    if (!(heights_[i] > kShin && heights_[i] < kHead)) continue;
    const auto cell = static_cast<std::uint32_t>(static_cast<int>(at.y()) * side_ + static_cast<int>(at.x()));
    if (head_[cell] == 0) filled_.push_back(cell);
    next_[i] = head_[cell];
    head_[cell] = i + 1;
  }
  std::ranges::sort(filled_);
}

void ClusterFinder::visit(std::uint32_t cell, std::span<const Vector3f> points, Body& body) {
  for (std::uint32_t link = std::exchange(head_[cell], 0U); link != 0; link = next_[link - 1]) {
    const Vector3f& p = points[link - 1];
    body.low = body.low.cwiseMin(p.head<2>());
    body.high = body.high.cwiseMax(p.head<2>());
    body.sum += p.head<2>().cast<double>();
    body.bottom = std::min(body.bottom, heights_[link - 1]);
    body.top = std::max(body.top, heights_[link - 1]);
    ++body.points;
  }
}

void ClusterFinder::flood(std::uint32_t first, std::span<const Vector3f> points, Body& body) {
  open_.assign(1, first);
  visit(first, points, body);
  while (!open_.empty()) {
    const auto cell = static_cast<int>(open_.back());
    open_.pop_back();
    for (int row = -1; row <= 1; ++row) {
      for (int column = -1; column <= 1; ++column) {
        const auto neighbour = static_cast<std::uint32_t>(cell + row * side_ + column);
        if (head_[neighbour] == 0) continue;
        visit(neighbour, points, body);
        open_.push_back(neighbour);
      }
    }
  }
}

const std::vector<Cluster>& ClusterFinder::find(std::span<const Vector3f> points, const Vector3f& sensor,
                                                float sensor_height_m) {
  ground_.fill(points, sensor, sensor_height_m);
  fill_cells(points, sensor);
  clusters_.clear();
  for (const std::uint32_t cell : filled_) {
    if (head_[cell] == 0) continue;
    Body body;
    flood(cell, points, body);
    if (body.points < kFewest || body.extent() > kWidest || body.bottom > kHighestBottom) continue;
    const Vector2f away = body.middle() - sensor.head<2>();
    const float seen_up_to = sensor_height_m + kSteepest * away.norm() - kCell;
    if (body.top < std::min(kLowestTop, seen_up_to)) continue;
    clusters_.push_back({.centre = body.middle() + kHalfBody * away.normalized(),
                         .ground = ground_.height(body.middle().x(), body.middle().y()),
                         .top = body.top,
                         .extent = body.extent(),
                         .points = body.points});
  }
  return clusters_;
}

}  // namespace cairn::people
