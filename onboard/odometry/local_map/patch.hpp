// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace cairn::odometry {

/// Sums over the points of one block, relative to the block's centre. Enough to fit a patch at any
/// time, and never growing: the points themselves are not kept.
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

/// What the points of one block look like: a piece of a plane, which fixes one direction, or
/// something slim and upright (a trunk, a column, a door post), which fixes two.
struct Patch {
  enum class Kind : std::uint8_t { kNone, kPlane, kPole };
  /// One axis of the patch and the spread of its points along it.
  struct Axis {
    Eigen::Vector3f direction = Eigen::Vector3f::Zero();  ///< unit length
    float variance = 0;                                   ///< of the points along it [m²]
  };
  Kind kind = Kind::kNone;
  bool lasting = false;  ///< seen for as long as PatchGrid::Limits says; if not, it is fresh
  Axis normal;           ///< of the plane, towards the side it was seen from; of a pole, the slimmer direction
  Axis second;           ///< of a pole
  Eigen::Vector3f centroid = Eigen::Vector3f::Zero();  ///< relative to the block's centre [m]
  float inverse_spread = 0;  ///< plane: 1 / the smaller in-plane variance of the points [1/m²]
  float count = 0;           ///< points in the fit
  float epoch = 0;           ///< mean epoch of the points

  /// Variance [m²] of a new measurement along `axis`, off the centroid by a squared lever: the
  /// spread of the points, plus the uncertainty of the fit, which grows with the lever arm.
  [[nodiscard]] float prediction_variance(const Axis& axis, float squared_lever) const {
    return axis.variance * (1.0F + (1.0F + squared_lever * inverse_spread) / count);
  }
  /// Variance of the plane normal's direction about either in-plane axis [rad²].
  [[nodiscard]] float tilt_variance() const { return normal.variance * inverse_spread / count; }
};

/// When a set of points counts as a plane or a pole. LidarOdometry takes the first two from its
/// config. The others were found with `odometry_accuracy` (tests/bench): what swept planes and
/// false poles did to forest, office and corridor.
struct PatchCriteria {
  float noise_floor_m = 0.01F;    ///< m. No patch is believed to be thinner.
  float max_thickness_m = 0.06F;  ///< m, of a plane: standard deviation across
  float min_flatness = 9.0F;  ///< of a plane: smaller in-plane variance over variance across; 3 in standard deviations
  /// rad, of a plane: standard deviation of the normal. It moves the rim of the largest block (1 m)
  /// by 0.03 m, the noise of a VLP-16 (data sheet).
  float max_tilt_rad = 0.03F;
  /// rad, of a plane: beams nearer to it are taken to have swept it, not hit it. Rings of a VLP-16
  /// are 0.035 rad apart.
  float min_incidence_rad = 0.05F;
  float min_points = 8.0F;  ///< a plane has three parameters, a thickness and a spread
  float pole_width =
      0.12F;  ///< of a pole: standard deviation across in edges, at most; 6, 12 and 24 cm in the three sizes
  /// rad, of a pole: standard deviation sideways as seen, at least. Neighbouring beams of a VLP-16
  /// at 10 Hz are 0.2° = 0.0035 rad apart (data sheet).
  float min_pole_rad = 0.0035F;
  float pole_height =
      0.2F;  ///< of a pole: standard deviation upwards in edges, at least; a full block has 1/√12 = 0.29
};

/// From where a block was looked at.
struct Viewpoint {
  Eigen::Vector3f to_sensor;  ///< from the block's centre [m]
  Eigen::Vector3f up;         ///< the sensor's axis of rotation
};

/// Least-squares patch through the points behind `m`, in a block of this edge. Gives Kind::kNone if
/// they are neither, and also if the patch lies so near a face that the block holds only one side
/// of it: the staggered grid has the same patch in the middle of its block.
[[nodiscard]] Patch fit_patch(const Moments& m, float edge, const PatchCriteria& criteria, const Viewpoint& from);

}  // namespace cairn::odometry
