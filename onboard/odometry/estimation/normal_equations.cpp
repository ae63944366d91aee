// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/normal_equations.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::odometry {
namespace {

// Squared standard deviations. A point within 3 σ of its patch is an inlier.
constexpr float kInlier = 9.0F;
// Share of the squared gate. While the gate is wide, the robust weight falls to a quarter at a
// third of it (√0.1).
constexpr float kKernelOfGate = 0.1F;

/// Σ (distance / σ)² over the rows.
float mahalanobis(const PatchMatch& m) {
  float sum = 0;
  for (int k = 0; k < m.rows; ++k) {
    const PatchMatch::Row& row = m.row[static_cast<std::size_t>(k)];
    sum += row.distance * row.distance / row.variance;
  }
  return sum;
}

bool is_inlier(const PatchMatch& m) { return m.kind == PatchMatch::Kind::kOn && mahalanobis(m) < kInlier; }

/// On a floor or a ceiling.
bool is_level(const PatchMatch& m) {
  return m.kind == PatchMatch::Kind::kOn && m.rows == 1 && std::abs(m.row[0].direction.z()) > kLevelCosine;
}

/// Fresh floors and ceilings count fully: with less, nothing held the height of a sensor that nods in a walker's hands.
bool is_fresh(const PatchMatch& m) { return !m.lasting && !is_level(m); }

/// Geman–McClure: full weight on the patch, a quarter at 3 σ (or at a third of the gate, while that
/// is wider).
float robust_weight(const PatchMatch& m, float gate) {
  const float scale = std::max(kInlier, kKernelOfGate * gate * gate / m.row[0].variance);
  const float k = scale / (scale + mahalanobis(m));
  return k * k;
}

/// Running sums of one chunk, in the layout the compiler can keep in registers.
class Accumulator {
 public:
  void add(const Eigen::Vector3f& q, float age, const Eigen::Vector3f& n_base, const PatchMatch::Row& row,
           float robust) {
    const double w = robust / row.variance, r = row.distance, t = age;
    Vector6 a;
    a << n_base.cast<double>(), q.cross(n_base).cast<double>();
    const Vector6 wa = w * a;
    const Matrix6 waa = wa * a.transpose();
    sum_.aa += waa;
    sum_.taa += t * waa;
    sum_.ttaa += (t * t) * waa;
    sum_.ar += r * wa;
    sum_.tar += (t * r) * wa;
    sum_.weight += w;
    sum_.robust += robust;
    sum_.squared_range += w * q.squaredNorm();
    sum_.chi2 += w * r * r;
    sum_.squared_distance += robust * r * r;
  }
  void count(const PatchMatch& m) {
    if (m.kind == PatchMatch::Kind::kNone) return;
    const int inlier = is_inlier(m) ? 1 : 0, telling = is_level(m) ? 0 : 1;
    sum_.matched += 1;
    sum_.inliers += inlier;
    sum_.telling += telling;
    sum_.telling_inliers += telling * inlier;
  }

  [[nodiscard]] const NormalEquations& sum() const { return sum_; }

 private:
  NormalEquations sum_;
};

}  // namespace

void NormalEquations::operator+=(const NormalEquations& o) {
  aa += o.aa;
  taa += o.taa;
  ttaa += o.ttaa;
  ar += o.ar;
  tar += o.tar;
  squared_range += o.squared_range;
  weight += o.weight;
  robust += o.robust;
  chi2 += o.chi2;
  squared_distance += o.squared_distance;
  matched += o.matched;
  inliers += o.inliers;
  telling += o.telling;
  telling_inliers += o.telling_inliers;
}

Linearise::Linearise(std::size_t max_keypoints) {
  partial_.reserve(max_keypoints / kChunk + 1);
  uses_.reserve(max_keypoints);
  rows_.reserve(2 * max_keypoints);
}

NormalEquations Linearise::operator()(std::span<const Keypoint> keypoints, const PatchMap& map, const Linearisation& at,
                                      Workers& workers) {
  const Deskew deskew(at.twist, at.T_base_lidar, at.duration_s);
  const Eigen::Matrix3d R = at.T_odom_base.rotation();
  const Eigen::Vector3d t = at.T_odom_base.translation();
  const Eigen::Matrix3f R_base_odom = R.transpose().cast<float>();
  const Eigen::Vector3d lidar = R * at.T_base_lidar.translation();
  const auto gate = static_cast<float>(at.gate_m), fresh_share = static_cast<float>(at.fresh_share);
  partial_.resize((keypoints.size() + kChunk - 1) / kChunk);
  uses_.assign(keypoints.size(), {});
  rows_.assign(2 * keypoints.size(), {});
  workers.for_each(partial_.size(), [&](std::size_t chunk) {
    Accumulator sum;
    const std::size_t end = std::min(keypoints.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      const Eigen::Vector3f q = deskew(keypoints[i].p_lidar, keypoints[i].age_s);
      const Eigen::Vector3d ray = R * q.cast<double>();
      const PatchMatch match = map.match(ray + t, (lidar - ray).cast<float>(), gate);
      sum.count(match);
      if (match.kind != PatchMatch::Kind::kOn) continue;
      const float robust = (is_fresh(match) ? fresh_share : 1.0F) * robust_weight(match, gate);
      uses_[i] = {robust / match.row[0].variance, match.epoch};
      for (int k = 0; k < match.rows; ++k) {
        const PatchMatch::Row& row = match.row[static_cast<std::size_t>(k)];
        const Eigen::Vector3f n_base = R_base_odom * row.direction;
        rows_[2 * i + static_cast<std::size_t>(k)] = {.normal = n_base, .point = q, .robust = robust};
        sum.add(q, keypoints[i].age_s, n_base, row, robust);
      }
    }
    partial_[chunk] = sum.sum();
  });
  NormalEquations total;
  for (const NormalEquations& p : partial_) total += p;
  return total;
}

}  // namespace cairn::odometry
