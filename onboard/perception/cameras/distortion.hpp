// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

namespace cairn::cameras {

/// How a lens bends rays.
enum class DistortionModel : std::uint8_t {
  kRadTan,       ///< OpenCV's: a rational function of the radius, and decentring (Brown, 1966)
  kEquidistant,  ///< OpenCV's fisheye: a polynomial of the angle (Kannala, Brandt, 2006)
};

/// Where a lens puts a ray. A point is (x/z, y/z) in the optical frame: right, down, both without unit.
struct Distortion {
  DistortionModel model = DistortionModel::kRadTan;
  /// kRadTan: k1 k2 p1 p2 k3 k4 k5 k6, OpenCV's order. kEquidistant: k1 k2 k3 k4. Zero: the term is missing.
  std::array<double, 8> k{};

  /// The distorted point of an ideal one. Only points within largest_radius() have a meaning.
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& ideal) const;
  /// Derivative of distort().
  [[nodiscard]] Eigen::Matrix2d jacobian(const Eigen::Vector2d& ideal) const;
  /// The ideal point of a distorted one, by at most 64 halvings and 10 Newton steps. None: no ray within `limit` (of
  /// largest_radius()) goes there.
  [[nodiscard]] std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted, double limit) const;
  /// Radius of ideal points up to which the distorted radius grows in every direction. Beyond it the polynomial turns
  /// back, and rays from far outside of the view would seem to fall into the picture. At most tan(89.9°).
  [[nodiscard]] double largest_radius() const;

 private:
  [[nodiscard]] double radial(double radius) const;
  [[nodiscard]] bool grows(double angle) const;
};

}  // namespace cairn::cameras
