// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/normal_equations.hpp"

#include <algorithm>

namespace cairn {
namespace {

/// Geman–McClure: full weight at the plane, a quarter at the scale, nothing far off.
float robust_weight(float squared_distance, float squared_scale) {
  const float k = squared_scale / (squared_scale + squared_distance);
  return k * k;
}

/// Running sums of one chunk, in the layout the compiler can keep in registers.
class Accumulator {
 public:
  void add(const Eigen::Vector3f& q, float age, const Eigen::Vector3f& n_base, const PlaneMatch& match, float robust) {
    const double w = robust / match.variance, r = match.distance, t = age;
    Vector6 a;
    a << n_base.cast<double>(), q.cross(n_base).cast<double>();
    const Vector6 wa = w * a;
    const Matrix6 waa = wa * a.transpose();
    sum_.aa += waa;
    sum_.taa += t * waa;
    sum_.ttaa += (t * t) * waa;
    sum_.ar += r * wa;
    sum_.tar += (t * r) * wa;
    add_tilt(q.cast<double>(), w * match.tilt_variance);
    sum_.weight += w;
    sum_.robust += robust;
    sum_.squared_range += w * q.squaredNorm();
    sum_.chi2 += w * r * r;
    sum_.squared_distance += robust * r * r;
  }
  void count(bool matched, bool inlier) {
    sum_.matched += matched ? 1 : 0;
    sum_.inliers += inlier ? 1 : 0;
  }

  [[nodiscard]] NormalEquations finish() const {
    NormalEquations out = sum_;
    out.spurious.topLeftCorner<3, 3>().diagonal().setConstant(tilt_);
    out.spurious.bottomLeftCorner<3, 3>() = hat(tilt_q_);
    out.spurious.topRightCorner<3, 3>() = -hat(tilt_q_);
    out.spurious.bottomRightCorner<3, 3>() = tilt_qq_.trace() * Eigen::Matrix3d::Identity() - tilt_qq_;
    return out;
  }

 private:
  void add_tilt(const Eigen::Vector3d& q, double w) {
    tilt_ += w;
    tilt_q_ += w * q;
    tilt_qq_ += w * q * q.transpose();
  }

  NormalEquations sum_;
  double tilt_ = 0;
  Eigen::Vector3d tilt_q_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d tilt_qq_ = Eigen::Matrix3d::Zero();
};

}  // namespace

void NormalEquations::operator+=(const NormalEquations& o) {
  aa += o.aa;
  taa += o.taa;
  ttaa += o.ttaa;
  ar += o.ar;
  tar += o.tar;
  spurious += o.spurious;
  squared_range += o.squared_range;
  weight += o.weight;
  robust += o.robust;
  chi2 += o.chi2;
  squared_distance += o.squared_distance;
  matched += o.matched;
  inliers += o.inliers;
}

Linearise::Linearise(std::size_t max_keypoints) {
  partial_.reserve(max_keypoints / kChunk + 1);
  uses_.reserve(max_keypoints);
}

NormalEquations Linearise::operator()(std::span<const Keypoint> keypoints, const PlaneMap& map, const Linearisation& at,
                                      Workers& workers) {
  const Deskew deskew(at.twist, at.T_base_lidar, at.duration_s);
  const Eigen::Matrix3d R = at.T_odom_base.rotation();
  const Eigen::Vector3d t = at.T_odom_base.translation();
  const Eigen::Matrix3f R_base_odom = R.transpose().cast<float>();
  const auto gate = static_cast<float>(at.gate_m);
  partial_.resize((keypoints.size() + kChunk - 1) / kChunk);
  uses_.assign(keypoints.size(), {});
  workers.for_each(partial_.size(), [&](std::size_t chunk) {
    Accumulator sum;
    const std::size_t end = std::min(keypoints.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      const Eigen::Vector3f q = deskew(keypoints[i].p_lidar, keypoints[i].age_s);
      const PlaneMatch match = map.match(R * q.cast<double>() + t, gate);
      const float squared = match.distance * match.distance;
      const bool on = match.kind == PlaneMatch::Kind::kOn;
      sum.count(match.kind != PlaneMatch::Kind::kNone, on && squared < 9.0F * match.variance);
      if (!on) continue;
      const float robust = robust_weight(squared, std::max(9.0F * match.variance, 0.1F * gate * gate));
      uses_[i] = {robust / match.variance, match.epoch};
      sum.add(q, keypoints[i].age_s, R_base_odom * match.normal, match, robust);
    }
    partial_[chunk] = sum.finish();
  });
  NormalEquations total;
  for (const NormalEquations& p : partial_) total += p;
  return total;
}

}  // namespace cairn
