// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/box_lifter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "hal/semantic_class.hpp"

namespace cairn::people {
namespace {

constexpr double kHeight = 1.72, kShoulders = 0.25;  // m: a usual person, and half its width
constexpr double kNearest = 0.5;                     // m along the view
// A box may be so much too high or too low for where its cluster stands: children, and people half hidden.
constexpr double kLowest = 0.45, kHighest = 1.6;
constexpr double kWorst = 0.7;  // mismatch
// Of a box without a cluster.
constexpr double kCore = 0.6;                             // of its width, around its middle
constexpr double kShallowest = 0.75, kDeepest = 1.3;      // of the depth at which a usual person fills it
constexpr double kFarthestLifted = 10, kFarthestCut = 3;  // m
constexpr double kThick = 0.5;                            // m along the view
constexpr std::size_t kFewestPoints = 6;

}  // namespace

BoxLifter::BoxLifter(const cameras::CameraModel& camera, const SE3& T_base_camera, double farthest_m)
    : camera_(camera),
      T_optical_base_((T_base_camera * cameras::T_camera_optical()).inverse()),
      farthest_(farthest_m) {}

BoxLifter::Seen BoxLifter::look_at(const Cluster& cluster, const SE3& T_optical_odom) const {
  const Eigen::Vector3d feet(cluster.centre.x(), cluster.centre.y(), cluster.ground);
  const Eigen::Vector3d foot = T_optical_odom * feet;
  const Eigen::Vector3d head = T_optical_odom * (feet + Eigen::Vector3d(0, 0, kHeight));
  const Eigen::Vector3d middle = 0.5 * (foot + head);
  Seen seen;
  seen.porous = cluster.porous();
  if (middle.z() < kNearest) return seen;
  seen.in_front = true;
  seen.depth = middle.z();
  seen.x = middle.x() / middle.z();
  seen.top = head.y() / middle.z();
  seen.bottom = foot.y() / middle.z();
  seen.half_width = kShoulders / middle.z();
  seen.in_view = !cluster.low && camera_.project({middle.x() - kShoulders, 0, middle.z()}).has_value() &&
                 camera_.project({middle.x() + kShoulders, 0, middle.z()}).has_value();
  return seen;
}

/// Boxes are in pixels of the picture that was looked at; another size than the calibration's is scaled.
std::optional<BoxLifter::Box> BoxLifter::box_of(const Detection& found, const Detections& picture) const {
  constexpr double kRim = 1.5;  // px
  const double u = static_cast<double>(camera_.width()) / picture.width;
  const double v = static_cast<double>(camera_.height()) / picture.height;
  const double x = found.x + 0.5 * found.width, y = found.y + 0.5 * found.height;
  const auto ray = [&](double px, double py) { return camera_.unproject({u * px - 0.5, v * py - 0.5}); };
  const auto left = ray(found.x, y), right = ray(found.x + found.width, y);
  const auto top = ray(x, found.y), bottom = ray(x, found.y + found.height);
  for (const auto& side : {left, right, top, bottom})
    if (!side || side->z() < 0.1) return std::nullopt;
  const bool cut_above = found.y < kRim;
  const bool cut_below = found.y + found.height > picture.height - kRim;
  return Box{.left = left->x() / left->z(),
             .right = right->x() / right->z(),
             .top = top->y() / top->z(),
             .bottom = bottom->y() / bottom->z(),
             .open_top = cut_above,
             .open_bottom = cut_below,
             .score = found.score};
}

/// 0: as it should be; infinite: this box is of something else. The sum of how far the cluster is from the middle of
/// the box, in half widths, and of how far its head is from the box's top, in heights.
double BoxLifter::mismatch(const Box& box, const Seen& seen) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (!seen.in_front || seen.porous) return kNever;
  const double half = std::max(0.5 * (box.right - box.left), seen.half_width);
  const double aside = std::abs(seen.x - 0.5 * (box.left + box.right)) / half;
  const double top = box.open_top ? std::max(seen.top, box.top) : seen.top;
  const double bottom = box.open_bottom ? std::min(seen.bottom, box.bottom) : seen.bottom;
  if (aside > 1 || bottom <= top) return kNever;
  const double ratio = (box.bottom - box.top) / (bottom - top);
  if (ratio < kLowest || ratio > kHighest) return kNever;
  // Hidden feet are usual, a hidden head is not: heads must be at the same height.
  const double heads = box.open_top ? 0 : std::abs(box.top - seen.top) / (bottom - top);
  return aside + heads;
}

/// The surest boxes choose first. Each cluster has at most one.
void BoxLifter::assign(const Detections& boxes) {
  order_.resize(boxes.found.size());
  std::iota(order_.begin(), order_.end(), 0U);
  std::ranges::stable_sort(order_, [&](auto a, auto b) { return boxes.found[a].score > boxes.found[b].score; });
  for (const std::uint32_t i : order_) {
    if (boxes.found[i].class_id != kPersonClass) continue;
    const auto box = box_of(boxes.found[i], boxes);
    if (!box) continue;
    double least = kWorst;
    std::size_t best = seen_.size();
    for (std::size_t k = 0; k < seen_.size(); ++k) {
      const double mismatched = mismatch(*box, seen_[k]);
      if (answers_[k].verdict == Verdict::kPerson || mismatched >= least) continue;
      least = mismatched;
      best = k;
    }
    if (best < seen_.size())
      answers_[best] = {Verdict::kPerson, box->score, seen_[best].depth};
    else
      apart_.push_back(*box);
  }
}

bool BoxLifter::covered(std::size_t i) const {
  return std::ranges::any_of(seen_, [&](const Seen& other) {
    return other.in_front && other.depth < seen_[i].depth - 0.3 &&
           std::abs(other.x - seen_[i].x) < other.half_width + seen_[i].half_width;
  });
}

/// Whatever its mount is, a camera shows somebody about as large as the distance says.
std::span<const BoxBeside> BoxLifter::offsets(const Detections& boxes, std::span<const Known> people,
                                              const SE3& T_odom_base) {
  const SE3 T_optical_odom = T_optical_base_ * T_odom_base.inverse();
  offsets_.clear();
  seen_.clear();
  for (const Known& person : people) seen_.push_back(look_at(person.body, T_optical_odom));
  std::vector<double> angles;
  for (const Detection& found : boxes.found) {
    const bool whole = found.x > 1 && found.x + found.width < static_cast<float>(boxes.width - 1);
    const auto box = found.class_id == kPersonClass && whole ? box_of(found, boxes) : std::nullopt;
    angles.push_back(box ? std::atan(0.5 * (box->left + box->right)) : 9);
  }
  for (std::size_t b = 0; b < angles.size(); ++b) {
    const auto beside = [&](double angle) { return std::abs(angle - angles[b]) < kBeside; };
    const auto seen_beside = [&](const Seen& s) { return s.in_front && beside(std::atan(s.x)); };
    if (angles[b] > 8 || std::ranges::count_if(angles, beside) != 1) continue;
    if (std::ranges::count_if(seen_, seen_beside) != 1) continue;
    const auto which = std::ranges::find_if(seen_, seen_beside);
    const Seen& seen = *which;
    if (seen.depth < kNotTooNear) continue;
    const auto box = box_of(boxes.found[b], boxes);
    const double ratio = (box->bottom - box->top) / (seen.bottom - seen.top);
    if (ratio > kLowest && ratio < kHighest)
      offsets_.push_back({people[static_cast<std::size_t>(which - seen_.begin())].id, angles[b] - std::atan(seen.x)});
  }
  return offsets_;
}

std::span<const Answer> BoxLifter::judge(const Detections& boxes, std::span<const Cluster> clusters,
                                         const SE3& T_odom_base) {
  T_optical_odom_ = T_optical_base_ * T_odom_base.inverse();
  seen_.clear();
  apart_.clear();
  for (const Cluster& cluster : clusters) seen_.push_back(look_at(cluster, T_optical_odom_));
  answers_.assign(clusters.size(), {});
  if (boxes.width < 1 || boxes.height < 1) return answers_;
  assign(boxes);
  for (std::size_t i = 0; i < seen_.size(); ++i)
    if (answers_[i].verdict == Verdict::kNothing && seen_[i].in_view && seen_[i].depth < farthest_ && !covered(i))
      answers_[i] = {Verdict::kSilence, 0, seen_[i].depth};
  return answers_;
}

/// The nearest of the depths at which many points are. A cut box tells the least depth only.
std::optional<Lifted> BoxLifter::lift(const Box& box, std::span<const Eigen::Vector3f> points_odom) const {
  const double height = box.bottom - box.top, middle = 0.5 * (box.left + box.right);
  const double half = kCore * 0.5 * (box.right - box.left);
  const bool cut = box.open_top || box.open_bottom;
  const double nearest = kNearest,
               farthest = cut ? kFarthestCut : std::min(kFarthestLifted, kDeepest * kHeight / height);
  const double least = cut ? nearest : kShallowest * kHeight / height;
  struct Within {
    double depth;
    const Eigen::Vector3f* point;
  };
  std::vector<Within> within;
  for (const Eigen::Vector3f& p : points_odom) {
    const Eigen::Vector3d q = T_optical_odom_ * p.cast<double>();
    if (q.z() < least || q.z() > farthest) continue;
    if (std::abs(q.x() / q.z() - middle) > half || q.y() / q.z() < box.top || q.y() / q.z() > box.bottom) continue;
    within.push_back({q.z(), &p});
  }
  std::ranges::sort(within, {}, &Within::depth);
  std::size_t last = 0;
  for (std::size_t first = 0; first < within.size(); ++first) {
    while (last < within.size() && within[last].depth < within[first].depth + kThick) ++last;
    if (last - first < kFewestPoints) continue;
    Eigen::Vector2d sum(0, 0);
    for (std::size_t i = first; i < last; ++i) sum += within[i].point->head<2>().cast<double>();
    return Lifted{.position = sum / static_cast<double>(last - first), .ground = 0, .score = box.score};
  }
  return std::nullopt;
}

std::vector<Lifted> BoxLifter::lift(std::span<const Eigen::Vector3f> points_odom) {
  std::vector<Lifted> lifted;
  for (const Box& box : apart_)
    if (const auto found = lift(box, points_odom)) lifted.push_back(*found);
  return lifted;
}

}  // namespace cairn::people
