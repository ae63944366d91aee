// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/bundle_adjuster.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "onboard/visual_odometry/landmark_view.hpp"

namespace cairn::visual_odometry {
namespace {

constexpr double kStepAtMost_m = 0.5;    // of a keyframe: a longer one means that nothing holds it
constexpr double kSettledBundle = 1e-5;  // m, rad: a smaller step ends the iteration
// Where few landmarks are in view, keyframes stay near where the filter had them: 1 σ of a step
constexpr double kHold_m = 0.05, kHold_rad = 0.02;

using Matrix6x3 = Eigen::Matrix<double, 6, 3>;

}  // namespace

/// What one keyframe says of one point.
struct BundleAdjuster::Row {
  LandmarkView view;
  Eigen::Vector3d error;   // seen − expected
  Eigen::Vector3d weight;  // with that of Cauchy
};

/// A point, eliminated: its step is `uncertainty` · (`towards` − Σ couplingᵀ · the step of each free keyframe).
struct BundleAdjuster::Elimination {
  struct Coupling {
    Eigen::Index slot;  // of the free keyframe
    Matrix6x3 w;
  };
  Eigen::Matrix3d information = 1e-9 * Eigen::Matrix3d::Identity();
  Eigen::Matrix3d uncertainty = Eigen::Matrix3d::Zero();  // inverse of `information`
  Eigen::Vector3d towards = Eigen::Vector3d::Zero();
  std::vector<Coupling> couplings;
};

/// Of the free keyframes' steps: `aa` · steps = `ar`. The lower triangle of `aa` is filled.
struct BundleAdjuster::Equations {
  Eigen::MatrixXd aa;
  Eigen::VectorXd ar;
};

BundleAdjuster::BundleAdjuster(const AdjustmentConfig& config, const stereo::StereoGeometry& geometry,
                               const SE3& T_base_eye)
    : config_(config), geometry_(geometry), T_eye_base_(T_base_eye.inverse()) {}

void BundleAdjuster::clear() {
  keyframes_.clear();
  points_.clear();
  oldest_ = 0;
}

void BundleAdjuster::add(const SE3& T_odom_base) {
  keyframes_.push_back(T_odom_base);
  if (keyframes_.size() <= static_cast<std::size_t>(config_.keyframes)) return;
  keyframes_.pop_front();
  ++oldest_;
  for (auto& [id, point] : points_) std::erase_if(point.views, [&](const View& v) { return v.keyframe < oldest_; });
  std::erase_if(points_, [](const auto& entry) { return entry.second.views.empty(); });
}

void BundleAdjuster::see(std::span<const Feature> features, const LandmarkMap& map) {
  const std::uint64_t keyframe = oldest_ + keyframes_.size() - 1;
  for (const Feature& f : features) {
    const Landmark* landmark = map.find(f.id);
    if (landmark == nullptr) continue;
    const auto [at, fresh] = points_.try_emplace(f.id);
    Point& point = at->second;
    if (fresh) point.p_odom = landmark->p_odom;
    if (!fresh && point.views.back().keyframe == keyframe) continue;
    point.views.push_back({keyframe, {f.left.x(), f.left.y(), f.disparity.value_or(0)}, f.disparity.has_value()});
  }
}

/// Keyframes that keep their poses: the first one alone as long as the window grows, and never the newest.
Eigen::Index BundleAdjuster::fixed() const {
  const auto all = static_cast<int>(keyframes_.size());
  const int most = std::clamp(config_.fixed, 1, all - 1);
  return std::clamp(all - (config_.keyframes - config_.fixed), 1, most);
}

bool BundleAdjuster::row(const View& view, const Point& point, Row& out) const {
  if (!view_landmark(geometry_, T_eye_base_, pose_of(view).inverse(), point.p_odom, {}, out.view)) return false;
  out.error = view.seen - out.view.expected;
  const double pixel = 1 / (config_.pixel_noise * config_.pixel_noise);
  out.weight = {pixel, pixel, view.both_eyes ? 1 / (config_.disparity_noise * config_.disparity_noise) : 0};
  out.weight *= 1 / (1 + out.error.cwiseAbs2().dot(out.weight));
  return true;
}

void BundleAdjuster::add_to(Equations& equations, const Point& point, Elimination& e) const {
  Row r;
  for (const View& view : point.views) {
    if (!row(view, point, r)) continue;
    const Eigen::Matrix3d weighted = r.view.by_point.transpose() * r.weight.asDiagonal();
    e.information += weighted * r.view.by_point;
    e.towards += weighted * r.error;
    const auto slot = static_cast<Eigen::Index>(view.keyframe - oldest_) - fixed();
    if (slot < 0) continue;
    const Matrix6x3 pose_weighted = r.view.by_pose.transpose() * r.weight.asDiagonal();
    equations.aa.block<6, 6>(6 * slot, 6 * slot) += pose_weighted * r.view.by_pose;
    equations.ar.segment<6>(6 * slot) += pose_weighted * r.error;
    e.couplings.push_back({slot, pose_weighted * r.view.by_point});
  }
  e.uncertainty = e.information.inverse();
  for (const auto& a : e.couplings) {
    const Matrix6x3 y = a.w * e.uncertainty;
    equations.ar.segment<6>(6 * a.slot) -= y * e.towards;
    for (const auto& b : e.couplings)
      if (b.slot <= a.slot) equations.aa.block<6, 6>(6 * a.slot, 6 * b.slot) -= y * b.w.transpose();
  }
}

/// False where the iteration ends.
bool BundleAdjuster::step() {
  const auto free = static_cast<Eigen::Index>(keyframes_.size()) - fixed();
  Equations equations{Eigen::MatrixXd::Zero(6 * free, 6 * free), Eigen::VectorXd::Zero(6 * free)};
  std::vector<std::pair<Point*, Elimination>> eliminated;
  for (auto& [id, point] : points_) {
    if (point.views.size() < 2) continue;
    eliminated.emplace_back(&point, Elimination{});
    add_to(equations, point, eliminated.back().second);
  }
  Vector6 hold;
  hold << Eigen::Vector3d::Constant(1 / (kHold_m * kHold_m)), Eigen::Vector3d::Constant(1 / (kHold_rad * kHold_rad));
  equations.aa.diagonal() += hold.replicate(free, 1);
  const Eigen::VectorXd moves = equations.aa.selfadjointView<Eigen::Lower>().ldlt().solve(equations.ar);
  if (!moves.allFinite() || moves.cwiseAbs().maxCoeff() > kStepAtMost_m) return false;
  for (auto& [point, e] : eliminated) {
    for (const auto& c : e.couplings) e.towards -= c.w.transpose() * moves.segment<6>(6 * c.slot);
    point->p_odom += e.uncertainty * e.towards;
    point->covariance = e.uncertainty;
  }
  for (Eigen::Index k = 0; k < free; ++k) {
    SE3& T = keyframes_[static_cast<std::size_t>(k + fixed())];
    T = T * SE3::exp(moves.segment<6>(6 * k));
  }
  return moves.norm() > kSettledBundle;
}

void BundleAdjuster::adjust(Budget& budget) {
  if (keyframes_.size() < 2) return;
  for (int i = 0; i < config_.max_steps && budget.one_more(); ++i)
    if (!step()) return;
}

void BundleAdjuster::place(LandmarkMap& map, double inflation) const {
  for (const auto& [id, point] : points_)
    if (point.views.size() > 1) map.move(id, point.p_odom, inflation * point.covariance);
}

}  // namespace cairn::visual_odometry
