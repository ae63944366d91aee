// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/cluster_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "onboard/perception/people/body.hpp"
#include "onboard/perception/people/plan_spread.hpp"
#include "onboard/perception/people/wall_cells.hpp"

namespace cairn::people {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kWidest = 1.1F;         // m: of somebody who strides
constexpr float kLowestTop = 0.9F;      // m: a child; what is lower is furniture
constexpr float kHighestBottom = 1.0F;  // m: what hangs in the air is no person
constexpr float kSteepest = 0.26F;      // tangent of a VLP-16's highest laser: near people have no heads
constexpr float kHalfBody = 0.12F;      // m from the side that is seen to the middle
constexpr float kOneBody = 0.65F;       // m; two together are wider
constexpr float kSeedReach = 0.45F;     // m from where somebody is expected
constexpr int kEdge = 1;                // cells around what has long stood there: its edges
constexpr std::uint32_t kFewest = 4;    // points
// Legs behind a desk. One leg is thin, and two are a stride apart.
constexpr float kHighestKnee = 0.6F, kHalfLeg = 0.06F, kStride = 0.5F;  // m
constexpr std::uint32_t kFewestOfLegs = 3;                              // points
// Somebody who stands, m. Of such bodies in two streets and an office that are not in the map, 99 % were people.
constexpr float kStands = 1.2F, kNarrow = 0.3F, kBroad = 0.85F;
constexpr std::uint32_t kWellSeen = 20;  // points
constexpr float kWellWithin = 7;         // m; from there on, a VLP-16's lasers are more than 0.24 m apart
// A piece of a wall: standard deviations along and across a line, m. Of bodies in simulated drives that are 0.1 to 0.14
// m along, 1 % of people's are less than 0.03 m across, and 77 % of all others. 0.02 is on the safe side.
constexpr double kLongPiece = 0.1, kThinPiece = 0.02;

Cluster joined(const Cluster& a, const Cluster& b) {
  const auto of_a = static_cast<float>(a.points), of_b = static_cast<float>(b.points);
  const auto mean = [&](const auto& x, const auto& y) { return (of_a * x + of_b * y) / (of_a + of_b); };
  Cluster both = a;
  both.extent = std::max({a.extent, b.extent, (a.centre - b.centre).norm()});
  both.centre = mean(a.centre, b.centre);
  both.entered = mean(a.entered, b.entered);
  both.known = mean(a.known, b.known);
  both.top = std::max(a.top, b.top);
  both.points += b.points;
  return both;
}

}  // namespace

struct ClusterFinder::Body {
  Vector2f low = Vector2f::Constant(std::numeric_limits<float>::infinity()), high = -low;
  PlanSpread plan;
  float bottom = kHead, top = 0;
  std::uint32_t entered = 0, known = 0;

  [[nodiscard]] float extent() const { return (high - low).maxCoeff(); }
  [[nodiscard]] Vector2f middle() const { return plan.middle().cast<float>(); }
  [[nodiscard]] float share(std::uint32_t points) const {
    return static_cast<float>(points) / static_cast<float>(plan.count());
  }
  [[nodiscard]] bool may_hold(const Vector2f& seed) const {
    return (seed.array() > low.array() - kSeedReach).all() && (seed.array() < high.array() + kSeedReach).all();
  }
};

ClusterFinder::ClusterFinder(double farthest_m)
    : farthest_(static_cast<float>(farthest_m)),
      side_(2 * static_cast<int>(std::ceil(farthest_m / kCell)) + 2 * WallCells::kReach),
      ground_(farthest_m),
      walls_(side_),
      head_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), 0),
      standing_(head_.size(), 0) {}

void ClusterFinder::measure(std::span<const Vector3f> points, const Vector3f& sensor, float sensor_height_m) {
  sensor_ = sensor;
  sensor_height_ = sensor_height_m;
  ground_.fill(points, sensor, sensor_height_m);
  heights_.assign(points.size(), 0.0F);
  walls_.clear();
  const auto side = static_cast<float>(side_);
  const Vector2f corner = sensor.head<2>().array() - 0.5F * kCell * side;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2f at = (points[i].head<2>() - corner) / kCell;
    // A rim of cells stays empty, so that every cell has its neighbours. What is not finite is not within, either.
    if (!(at.array() >= WallCells::kReach).all() || !(at.array() < side - WallCells::kReach).all()) continue;
    if ((points[i].head<2>() - sensor.head<2>()).norm() > farthest_) continue;
    heights_[i] = points[i].z() - ground_.height(points[i].x(), points[i].y());
    if (at_body_height(i)) walls_.add(cell_of(points[i]), points[i].head<2>());
  }
  walls_.judge();
}

std::uint32_t ClusterFinder::cell_of(const Vector3f& point) const {
  const Vector2f corner = sensor_.head<2>().array() - 0.5F * kCell * static_cast<float>(side_);
  const Vector2f at = (point.head<2>() - corner) / kCell;
  return static_cast<std::uint32_t>(static_cast<int>(at.y()) * side_ + static_cast<int>(at.x()));
}

void ClusterFinder::put(std::uint32_t point, std::uint32_t cell) {
  if (head_[cell] == 0) filled_.push_back(cell);
  next_[point] = head_[cell];
  head_[cell] = point + 1;
}

/// Cells with something that has long stood there. A body in front of it is not in them.
void ClusterFinder::mark_standing(std::span<const Vector3f> points, std::span<const Space> spaces) {
  for (const std::uint32_t cell : standing_cells_) standing_[cell] = 0;
  standing_cells_.clear();
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (spaces[i] != Space::kSettled || !at_body_height(i)) continue;
    const std::uint32_t cell = cell_of(points[i]);
    if (standing_[cell]++ == 0) standing_cells_.push_back(cell);
  }
}

/// Who came into a free place may be close to a wall.
bool ClusterFinder::beside_standing(std::uint32_t cell, Space space) const {
  const int reach = space == Space::kFree ? 0 : kEdge;
  for (int row = -reach; row <= reach; ++row)
    for (int column = -reach; column <= reach; ++column)
      if (standing_[static_cast<std::uint32_t>(static_cast<int>(cell) + row * side_ + column)] != 0) return true;
  return false;
}

void ClusterFinder::fill_cells(std::span<const Vector3f> points, const ClusterChoice& choice) {
  std::ranges::fill(head_, 0U);
  filled_.clear();
  next_.resize(points.size());
  if (choice.loose) mark_standing(points, choice.spaces);
  if (choice.loose) loose_.assign(points.size(), 0);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!at_body_height(i)) continue;
    const std::uint32_t cell = cell_of(points[i]);
    if (choice.loose) {
      if (choice.spaces[i] == Space::kSettled || beside_standing(cell, choice.spaces[i])) continue;
      loose_[i] = 1;
    }
    put(i, cell);
  }
  std::ranges::sort(filled_);
}

void ClusterFinder::visit(std::uint32_t cell) {
  for (std::uint32_t link = std::exchange(head_[cell], 0U); link != 0; link = next_[link - 1])
    members_.push_back(link - 1);
}

void ClusterFinder::flood(std::uint32_t first) {
  members_.clear();
  open_.assign(1, first);
  visit(first);
  while (!open_.empty()) {
    const auto cell = static_cast<int>(open_.back());
    open_.pop_back();
    for (int row = -1; row <= 1; ++row) {
      for (int column = -1; column <= 1; ++column) {
        const auto neighbour = static_cast<std::uint32_t>(cell + row * side_ + column);
        if (head_[neighbour] == 0) continue;
        visit(neighbour);
        open_.push_back(neighbour);
      }
    }
  }
}

ClusterFinder::Body ClusterFinder::body_of(std::span<const std::uint32_t> members, std::span<const Vector3f> points,
                                           const ClusterChoice& choice) const {
  Body body;
  for (const std::uint32_t i : members) {
    const Vector3f& p = points[i];
    body.low = body.low.cwiseMin(p.head<2>());
    body.high = body.high.cwiseMax(p.head<2>());
    body.plan.add(p.head<2>());
    body.bottom = std::min(body.bottom, heights_[i]);
    body.top = std::max(body.top, heights_[i]);
    if (choice.spaces.empty()) continue;
    if (choice.spaces[i] == Space::kFree) ++body.entered;
    if (choice.spaces[i] == Space::kNew || choice.spaces[i] == Space::kSettled) ++body.known;
  }
  return body;
}

bool ClusterFinder::is_upright(const Body& body, float seen_up_to) {
  const float extent = body.extent();
  return body.plan.count() >= kWellSeen && body.top >= std::min(kStands, seen_up_to - kCell) && extent >= kNarrow &&
         extent <= kBroad;
}

void ClusterFinder::add_if_person_sized(const Body& body) {
  if (body.extent() > kWidest || body.bottom > kHighestBottom) return;
  if (body.plan.on_a_line(kLongPiece, kThinPiece)) return;
  const Vector2f away = body.middle() - sensor_.head<2>();
  const float ground = ground_at(body.middle());
  const float seen_up_to = sensor_.z() - ground + kSteepest * away.norm() - kCell;
  if (body.top < std::min(kLowestTop, seen_up_to)) return add_low(body);
  if (body.plan.count() < kFewest) return;
  clusters_.push_back({.centre = body.middle() + kHalfBody * away.normalized(),
                       .ground = ground,
                       .top = body.top,
                       .extent = body.extent(),
                       .points = body.plan.count(),
                       .entered = body.share(body.entered),
                       .known = body.share(body.known),
                       .upright = away.norm() < kWellWithin && is_upright(body, seen_up_to)});
}

/// What is too low for a person may be legs. Whether something hides the rest is not known here.
void ClusterFinder::add_low(const Body& body) {
  if (body.plan.count() < kFewestOfLegs || body.bottom > kHighestKnee) return;
  const Vector2f away = body.middle() - sensor_.head<2>();
  low_.push_back({.centre = body.middle() + kHalfLeg * away.normalized(),
                  .ground = ground_at(body.middle()),
                  .top = body.top,
                  .extent = body.extent(),
                  .points = body.plan.count(),
                  .entered = body.share(body.entered),
                  .known = body.share(body.known),
                  .low = true});
}

/// Two legs are one body. Beside a body that is high enough they are its own.
void ClusterFinder::join_low() {
  const auto first = static_cast<std::ptrdiff_t>(clusters_.size());
  for (const Cluster& leg : low_) {
    const auto beside = [&](const Cluster& other) { return (other.centre - leg.centre).norm() < kStride; };
    if (std::any_of(clusters_.begin(), clusters_.begin() + first, beside)) continue;
    const auto other = std::find_if(clusters_.begin() + first, clusters_.end(), beside);
    if (other == clusters_.end())
      clusters_.push_back(leg);
    else
      *other = joined(*other, leg);
  }
}

/// Each point is of the nearest person who is expected there. What is of nobody is put back.
void ClusterFinder::part(std::span<const Vector3f> points, const ClusterChoice& choice, const Body& whole) {
  std::vector<Vector2f> seeds;
  for (const Eigen::Vector2d& seed : choice.seeds)
    if (whole.may_hold(seed.cast<float>())) seeds.push_back(seed.cast<float>());
  if (seeds.empty() || (seeds.size() == 1 && whole.extent() <= kWidest)) return add_if_person_sized(whole);
  of_seed_.resize(std::max(of_seed_.size(), seeds.size()));
  for (auto& members : of_seed_) members.clear();
  for (const std::uint32_t i : members_) {
    const auto nearest = std::ranges::min_element(
        seeds, {}, [&](const Vector2f& seed) { return (points[i].head<2>() - seed).squaredNorm(); });
    if ((points[i].head<2>() - *nearest).norm() < kSeedReach)
      of_seed_[static_cast<std::size_t>(nearest - seeds.begin())].push_back(i);
    else
      put(i, cell_of(points[i]));
  }
  for (std::size_t s = 0; s < seeds.size(); ++s)
    if (!of_seed_[s].empty()) add_if_person_sized(body_of(of_seed_[s], points, choice));
}

const std::vector<Cluster>& ClusterFinder::find(std::span<const Vector3f> points, const ClusterChoice& choice) {
  fill_cells(points, choice);
  clusters_.clear();
  low_.clear();
  const std::size_t first_round = filled_.size();
  for (std::size_t k = 0; k < filled_.size(); ++k) {  // it grows by what is put back
    if (head_[filled_[k]] == 0) continue;
    flood(filled_[k]);
    const Body body = body_of(members_, points, choice);
    if (k < first_round && body.extent() > kOneBody)
      part(points, choice, body);
    else
      add_if_person_sized(body);
  }
  if (choice.loose) join_low();
  return clusters_;
}

}  // namespace cairn::people
