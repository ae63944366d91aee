// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/constellations.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace cairn::matching {
namespace {

// All are chosen by hand. On 72 pairs of tests/bench/matching_pairs, seeds 1000 to 1017, pairs from
// 2 m on, and 0.4 or 0.8 m between the same landmarks, made a difference of one pair at most to how
// often the truth came first.

// Of a pair of landmarks. A short one tells little about the heading; a long one goes beyond what
// two maps share.
constexpr float kShortest_m = 4, kLongest_m = 50;
// Of two pairs' lengths.
constexpr float kLengthOff_m = 0.4F;
// Between two landmarks that are the same one.
constexpr float kSame_m = 0.6F;
// Length of Landmark::cross from which a corner has directions that must agree. Without
// this rule, 41 instead of 43 of 48 truths of halls and outdoor places were proposed, in twice the time.
constexpr float kCrossed = 0.3F;
// Of four times the angle between two crosses: 15°. Of the angle between the ways they face: 90°.
constexpr float kLeastCrossCos = 0.5F, kLeastFacingCos = 0;
// A pair's own two landmarks, and a little more.
constexpr float kLeastScore = 2;
// Placements before those that are the same place are left out.
constexpr std::size_t kCandidates = 4000;

/// Two landmarks of one map.
struct Pair {
  float length_m;
  std::size_t first, second;
};

/// The pairs of the strongest landmarks, each with the stronger one second, in order of it.
std::vector<Pair> pairs_of(std::span<const Landmark> strongest_first, std::size_t most) {
  std::vector<Pair> pairs;
  for (std::size_t second = 1; second < strongest_first.size(); ++second)
    for (std::size_t first = 0; first < second && pairs.size() < most; ++first) {
      const float length = (strongest_first[first].at - strongest_first[second].at).norm();
      if (length >= kShortest_m && length <= kLongest_m) pairs.push_back({length, first, second});
    }
  return pairs;
}

/// A pose on the plan: p of b is at turn·p + shift of a.
struct PlanPose {
  PlanPose(float yaw_rad, const Eigen::Vector2f& from_b, const Eigen::Vector2f& to_a)
      : yaw(yaw_rad),
        turn(Eigen::Rotation2Df(yaw_rad)),
        turn_four_times(Eigen::Rotation2Df(4 * yaw_rad)),
        shift(to_a - turn * from_b) {}
  [[nodiscard]] Eigen::Vector2f operator*(const Eigen::Vector2f& p) const { return turn * p + shift; }

  float yaw;
  Eigen::Matrix2f turn, turn_four_times;
  Eigen::Vector2f shift;
};

/// Whether two landmarks can be the same one under a pose.
bool alike(const Landmark& a, const Landmark& b, const PlanPose& pose) {
  const float crossed_a = a.cross.norm(), crossed_b = b.cross.norm();
  if (crossed_a < kCrossed || crossed_b < kCrossed) return true;
  return a.cross.dot(pose.turn_four_times * b.cross) >= kLeastCrossCos * crossed_a * crossed_b &&
         a.facing.dot(pose.turn * b.facing) >= kLeastFacingCos * a.facing.norm() * b.facing.norm();
}

/// Where b comes to lie when two of its landmarks are laid on two of a.
PlanPose laid_on(const Landmark& a1, const Landmark& a2, const Landmark& b1, const Landmark& b2) {
  const Eigen::Vector2f along_a = a2.at - a1.at, along_b = b2.at - b1.at;
  const float yaw = std::atan2(along_a.y(), along_a.x()) - std::atan2(along_b.y(), along_b.x());
  return {yaw, 0.5F * (b1.at + b2.at), 0.5F * (a1.at + a2.at)};
}

/// The landmarks of a, found by their place: a grid of cells kSame_m wide.
class Sky {
 public:
  explicit Sky(std::span<const Landmark> all) : all_(all) {
    if (all.empty()) return;
    Eigen::Vector2f high = all.front().at;
    low_ = high;
    for (const Landmark& l : all) {
      low_ = low_.cwiseMin(l.at);
      high = high.cwiseMax(l.at);
    }
    low_ -= Eigen::Vector2f::Constant(kSame_m);
    cell_m_ = std::max(kSame_m, (high - low_).maxCoeff() / kMostCells);
    size_ = ((high - low_) / cell_m_).array().floor().cast<int>() + 2;
    cells_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) + 1);
    taken_.resize(cells_.size());
    for (std::size_t i = 0; i < all.size(); ++i) enter(i);
  }

  /// The nearest landmark that can be `b`, and how near it is: 1 at the same place, 0 and none from
  /// kSame_m on.
  [[nodiscard]] std::pair<const Landmark*, float> same(const Landmark& b, const PlanPose& pose) const {
    const Eigen::Vector2f at = pose * b.at, cell = (at - low_) / cell_m_;
    std::pair<const Landmark*, float> best{nullptr, 0};
    for (const std::size_t i : cells_[slot(cell.x(), cell.y())]) {
      const float near = 1 - (all_[i].at - at).norm() / kSame_m;
      if (near > best.second && alike(all_[i], b, pose)) best = {&all_[i], near};
    }
    return best;
  }

  /// The cells in which places of b lie, without rounding. As same() computes them.
  void to_cells(const PlanPose& pose, const Eigen::ArrayXf& x, const Eigen::ArrayXf& y, Eigen::ArrayXf& cell_x,
                Eigen::ArrayXf& cell_y) const {
    const Eigen::Matrix2f& t = pose.turn;
    cell_x = (t(0, 0) * x + t(0, 1) * y + pose.shift.x() - low_.x()) / cell_m_;
    cell_y = (t(1, 0) * x + t(1, 1) * y + pose.shift.y() - low_.y()) / cell_m_;
  }
  /// Whether a landmark is near this cell.
  [[nodiscard]] bool taken(float x, float y) const { return taken_[slot(x, y)]; }

 private:
  static constexpr float kMostCells = 1000;  // along an edge: 600 m of cells; a bound on memory

  [[nodiscard]] std::size_t slot(const Eigen::Vector2i& cell) const {
    return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(cell.x());
  }
  /// The last slot, which stays empty, stands for all that lies outside.
  [[nodiscard]] std::size_t slot(float x, float y) const {
    const bool inside = static_cast<int>(x >= 0) & static_cast<int>(y >= 0) & static_cast<int>(x < float(size_.x())) &
                        static_cast<int>(y < float(size_.y()));
    return inside ? slot({static_cast<int>(x), static_cast<int>(y)}) : cells_.size() - 1;
  }
  /// Into its own cell and those around it.
  void enter(std::size_t i) {
    const Eigen::Vector2i home = ((all_[i].at - low_) / cell_m_).cast<int>();
    for (int y = std::max(0, home.y() - 1); y <= std::min(size_.y() - 1, home.y() + 1); ++y)
      for (int x = std::max(0, home.x() - 1); x <= std::min(size_.x() - 1, home.x() + 1); ++x) enter(i, slot({x, y}));
  }
  void enter(std::size_t i, std::size_t cell) {
    cells_[cell].push_back(i);
    taken_[cell] = true;
  }

  std::span<const Landmark> all_;
  Eigen::Vector2f low_ = Eigen::Vector2f::Zero();
  float cell_m_ = kSame_m;
  Eigen::Vector2i size_ = Eigen::Vector2i::Zero();
  std::vector<std::vector<std::size_t>> cells_ = std::vector<std::vector<std::size_t>>(1);
  std::vector<bool> taken_{false};  // cells that are not empty: a bit of each stays in the processor's cache
};

/// The landmarks of b, laid on the sky of a under one pose after another.
class Figure {
 public:
  Figure(const Sky& sky, std::span<const Landmark> all)
      : sky_(sky), all_(all), x_(all.size()), y_(all.size()), cell_x_(all.size()), cell_y_(all.size()) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      x_[static_cast<Eigen::Index>(i)] = all[i].at.x();
      y_[static_cast<Eigen::Index>(i)] = all[i].at.y();
    }
    met_.resize(all.size() + 1);
  }

  /// How many landmarks come near one of a. Hardly any pose of a search brings many, so this is made to be fast: many
  /// landmarks are moved by one instruction, and nothing is decided on the way.
  std::size_t lay(const PlanPose& pose) {
    sky_.to_cells(pose, x_, y_, cell_x_, cell_y_);
    count_ = 0;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      met_[count_] = i;
      count_ += sky_.taken(cell_x_[static_cast<Eigen::Index>(i)], cell_y_[static_cast<Eigen::Index>(i)]) ? 1U : 0U;
    }
    return count_;
  }
  /// How near they come, in all: at most 1 each. `pose` as in lay().
  [[nodiscard]] float score(const PlanPose& pose) const {
    float sum = 0;
    for (const std::size_t i : std::span(met_).first(count_)) sum += sky_.same(all_[i], pose).second;
    return sum;
  }

 private:
  const Sky& sky_;
  std::span<const Landmark> all_;
  Eigen::ArrayXf x_, y_;            // of the landmarks, m
  Eigen::ArrayXf cell_x_, cell_y_;  // of the sky, where they lie
  std::vector<std::size_t> met_;    // landmarks that come near one of a; one more than there are, for the loop
  std::size_t count_ = 0;           // of these
};

/// The pose that brings the landmarks nearest to their partners under `pose`, by least squares with
/// weights (Umeyama, PAMI 1991).
PlanPose fitted(const Sky& a, std::span<const Landmark> b, const PlanPose& pose) {
  Eigen::Vector2f middle_a = Eigen::Vector2f::Zero(), middle_b = middle_a;
  float weight = 0;
  for (const Landmark& l : b) {
    const auto [partner, near] = a.same(l, pose);
    if (partner == nullptr) continue;
    middle_a += near * partner->at;
    middle_b += near * l.at;
    weight += near;
  }
  if (weight == 0) return pose;
  middle_a /= weight;
  middle_b /= weight;
  float along = 0, across = 0;
  for (const Landmark& l : b) {
    const auto [partner, near] = a.same(l, pose);
    if (partner == nullptr) continue;
    const Eigen::Vector2f p = partner->at - middle_a, q = l.at - middle_b;
    along += near * p.dot(q);
    across += near * (q.x() * p.y() - q.y() * p.x());
  }
  return {std::atan2(across, along), middle_b, middle_a};
}

/// Poses with their scores. Those with the most are kept.
class Candidates {
 public:
  /// Whether a score of `most` could be among those that are kept.
  [[nodiscard]] bool wants(float most) const { return most >= kLeastScore && most > beaten_; }
  void add(const PlanPose& pose, float score) {
    if (!wants(score)) return;
    all_.emplace_back(score, pose);
    if (all_.size() == 2 * kCandidates) trim();
  }
  [[nodiscard]] const std::vector<std::pair<float, PlanPose>>& best_first() {
    trim();
    return all_;
  }

 private:
  void trim() {
    std::stable_sort(all_.begin(), all_.end(), [](const auto& p, const auto& q) { return p.first > q.first; });
    if (all_.size() < kCandidates) return;
    all_.erase(all_.begin() + kCandidates, all_.end());
    beaten_ = all_.back().first;  // of two that are equal, the first is kept
  }

  std::vector<std::pair<float, PlanPose>> all_;
  float beaten_ = 0;  // the least score of as many as are kept
};

Candidates candidates(std::span<const Landmark> a, Figure& figure, std::span<const Landmark> b,
                      const ConstellationConfig& config, Budget& budget) {
  auto pairs_a = pairs_of(a, config.pairs);
  const auto shorter = [](const Pair& p, const Pair& q) { return p.length_m < q.length_m; };
  std::stable_sort(pairs_a.begin(), pairs_a.end(), shorter);
  Candidates found;
  std::size_t second = 0;
  for (const Pair& in_b : pairs_of(b, config.pairs)) {
    if (in_b.second != second && !budget.one_more()) break;
    second = in_b.second;
    const auto from =
        std::lower_bound(pairs_a.begin(), pairs_a.end(), Pair{in_b.length_m - kLengthOff_m, 0, 0}, shorter);
    const auto to = std::upper_bound(from, pairs_a.end(), Pair{in_b.length_m + kLengthOff_m, 0, 0}, shorter);
    for (auto in_a = from; in_a != to; ++in_a)
      for (const auto& [i, j] : {std::pair(in_a->first, in_a->second), std::pair(in_a->second, in_a->first)}) {
        const PlanPose pose = laid_on(a[i], a[j], b[in_b.first], b[in_b.second]);
        if (!alike(a[i], b[in_b.first], pose) || !alike(a[j], b[in_b.second], pose)) continue;
        if (found.wants(static_cast<float>(figure.lay(pose)))) found.add(pose, figure.score(pose));
      }
  }
  return found;
}

}  // namespace

std::vector<Placement> constellations(std::span<const Landmark> a, std::span<const Landmark> b,
                                      const Eigen::Vector2f& middle_b, const ConstellationConfig& config,
                                      Budget& budget) {
  const Sky sky(a);
  Figure figure(sky, b);
  Candidates found = candidates(a, figure, b, config, budget);
  std::vector<Placement> all;
  for (const auto& [first_score, first_pose] : found.best_first()) {
    const PlanPose pose = fitted(sky, b, first_pose);
    const Eigen::Vector2d at = (pose * middle_b).cast<double>();
    figure.lay(pose);
    all.push_back(
        {.yaw_rad = static_cast<double>(pose.yaw), .x_m = at.x(), .y_m = at.y(), .score = figure.score(pose)});
  }
  return different_places(std::move(all), config.placements);
}

}  // namespace cairn::matching
