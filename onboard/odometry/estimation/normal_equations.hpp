// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "hal/workers.hpp"
#include "onboard/odometry/estimation/deskew.hpp"
#include "onboard/odometry/local_map/patch_map.hpp"

namespace cairn::odometry {

/// A point chosen for registration.
struct Keypoint {
  Eigen::Vector3f p_lidar;  ///< as measured, not deskewed
  float age_s;              ///< stamp − firing time
};

/// Weighted point-to-plane least squares over the pose and the twist, linearised at one state.
///
/// Residual of a point q = exp(−τ·twist)·p in base_link: r = n·(T_odom_base q − c). With a = ∂r/∂δ
/// = [Rᵀn; q × Rᵀn] for T·exp(δ), the twist's derivative is −τ·a to first order, so three sums of
/// a·aᵀ hold the whole 12×12 system.
struct NormalEquations {
  Matrix6 aa = Matrix6::Zero();    ///< Σ w a aᵀ
  Matrix6 taa = Matrix6::Zero();   ///< Σ w τ a aᵀ
  Matrix6 ttaa = Matrix6::Zero();  ///< Σ w τ² a aᵀ
  Vector6 ar = Vector6::Zero();    ///< Σ w a r
  Vector6 tar = Vector6::Zero();   ///< Σ w τ a r
  double squared_range = 0;        ///< Σ w |q|²
  double weight = 0;               ///< Σ w
  double robust = 0;               ///< Σ w·variance = Σ of the robust weights
  double chi2 = 0;                 ///< Σ w r²
  double squared_distance = 0;     ///< Σ robust weight · r²
  int matched = 0;                 ///< points whose neighbourhood holds a plane
  int inliers = 0;                 ///< of these, within 3 σ of it
  int telling = 0;                 ///< of `matched`, those not on a floor or ceiling, which fits anywhere
  int telling_inliers = 0;         ///< of these, within 3 σ of their patch

  void operator+=(const NormalEquations& o);
};

/// Cosine of 32°, between a patch's normal and the axis z of odom. A flatter patch is a floor or a
/// ceiling: no robot climbs and no hand tilts a sensor that far.
inline constexpr float kLevelCosine = 0.85F;

/// State at which to linearise, and how wide to look.
struct Linearisation {
  SE3 T_odom_base;
  Vector6 twist;  ///< of base_link, in base_link
  SE3 T_base_lidar;
  double duration_s;       ///< oldest age among the keypoints
  double gate_m;           ///< association distance; the robust kernel is scaled with it
  double fresh_share = 1;  ///< of its weight, what a point on a fresh patch counts
};

/// How much a keypoint counted, and with which part of the map. Weight 0: not used.
struct KeypointUse {
  float weight = 0;  ///< robust weight over the variance of its distance [1/m²]
  float epoch = 0;   ///< mean epoch of its patch, see DriftHistory
};

/// One residual: a point and the direction in which its patch holds it, both in base_link. robust
/// 0: not used.
struct ResidualRow {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  float robust = 0;  ///< robust weight, 0…1
};

/// Sums over all keypoints in chunks of fixed size, reduced in order: the same bits for any number
/// of threads.
class Linearise {
 public:
  explicit Linearise(std::size_t max_keypoints);
  NormalEquations operator()(std::span<const Keypoint> keypoints, const PatchMap& map, const Linearisation& at,
                             Workers& workers);
  /// Of the last call, one per keypoint.
  [[nodiscard]] std::span<const KeypointUse> uses() const { return uses_; }
  [[nodiscard]] std::span<const ResidualRow> rows() const { return rows_; }

 private:
  /// Keypoints per job of the workers: 20 jobs for the default number. Other chunks give other sums
  /// in the last bits.
  static constexpr std::size_t kChunk = 128;
  std::vector<NormalEquations> partial_;
  std::vector<KeypointUse> uses_;
  std::vector<ResidualRow> rows_;  // two per keypoint
};

}  // namespace cairn::odometry
