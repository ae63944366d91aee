// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace cairn {

/// Sums over the points of one block, relative to the block's centre. Enough to fit a plane at any time, and never
/// growing: the points themselves are not kept.
struct Moments {
  float count = 0;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  float epoch_sum = 0;  ///< of the epochs (see DriftHistory) the points were placed in

  void add(const Eigen::Vector3f& d, float epoch) {
    count += 1;
    sum += d;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    xz += d.x() * d.z();
    yy += d.y() * d.y();
    yz += d.y() * d.z();
    zz += d.z() * d.z();
    epoch_sum += epoch;
  }
};

/// A plane patch fitted to the points of one block.
struct Plane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit length; the sign is arbitrary
  float variance = 0;                                  ///< of a point's distance to the plane [m²]
  Eigen::Vector3f centroid = Eigen::Vector3f::Zero();  ///< relative to the block's centre [m]
  float inverse_spread = 0;                            ///< 1 / the smaller in-plane variance of the points [1/m²]
  float count = 0;                                     ///< points in the fit; 0: the block holds no plane
  float epoch = 0;                                     ///< mean epoch of the points

  /// Variance [m²] of (distance of a new measurement at `from_centroid`) under this plane: the noise of one point, plus
  /// the uncertainty of the fit, which grows with the lever arm.
  [[nodiscard]] float prediction_variance(float squared_lever) const {
    return variance * (1.0F + (1.0F + squared_lever * inverse_spread) / count);
  }
  /// Variance of the normal's direction about either in-plane axis [rad²].
  [[nodiscard]] float tilt_variance() const { return variance * inverse_spread / count; }
};

/// When a set of points counts as a plane.
struct PlaneCriteria {
  float noise_floor_m = 0.01F;    ///< no plane is believed to be thinner
  float max_thickness_m = 0.06F;  ///< standard deviation across the plane
  float min_flatness = 9.0F;      ///< smaller in-plane variance over variance across
  float max_tilt_rad = 0.03F;     ///< standard deviation of the normal
  float min_points = 8.0F;
};

/// Least-squares plane through the points behind `m`, in a block of this edge. Returns count = 0 if they are no plane,
/// and also if a plane nearly parallel to a face lies so close to it that the block holds only one side of the noise:
/// the staggered grid has the same plane in the middle of its block.
[[nodiscard]] Plane fit_plane(const Moments& m, float edge, const PlaneCriteria& criteria);

}  // namespace cairn
