// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/cameras/distortion.hpp"

#include <cmath>
#include <numbers>

namespace cairn::cameras {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Coefficients = std::array<double, 8>;

constexpr double kLargestAngle = 89.9 * std::numbers::pi / 180;  // rad
constexpr double kSmallestRadius = 1e-9;                         // nearer to the axis, a fisheye is a pinhole

/// The factor of the radius and its derivative by the squared radius.
struct Factor {
  double value, derivative;
};

/// k1 r² + k2 r⁴ + k3 r⁶ with the 1 in front.
Factor polynomial(double k1, double k2, double k3, double s) {
  return {1 + s * (k1 + s * (k2 + s * k3)), k1 + s * (2 * k2 + s * 3 * k3)};
}

double denominator(const Coefficients& k, double s) { return polynomial(k[5], k[6], k[7], s).value; }

Factor rational(const Coefficients& k, double s) {
  const Factor n = polynomial(k[0], k[1], k[4], s), d = polynomial(k[5], k[6], k[7], s);
  return {n.value / d.value, (n.derivative * d.value - n.value * d.derivative) / (d.value * d.value)};
}

/// θ + k1 θ³ + k2 θ⁵ + k3 θ⁷ + k4 θ⁹, and its derivative.
Factor fisheye(const Coefficients& k, double angle) {
  const double s = angle * angle;
  return {angle * (1 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3])))),
          1 + s * (3 * k[0] + s * (5 * k[1] + s * (7 * k[2] + s * 9 * k[3])))};
}

}  // namespace

Vector2d Distortion::distort(const Vector2d& ideal) const {
  const double x = ideal.x(), y = ideal.y(), s = x * x + y * y;
  if (model == DistortionModel::kEquidistant) {
    const double r = std::sqrt(s);
    return r < kSmallestRadius ? ideal : Vector2d(ideal * (fisheye(k, std::atan(r)).value / r));
  }
  const double f = rational(k, s).value;
  return {f * x + 2 * k[2] * x * y + k[3] * (s + 2 * x * x), f * y + k[2] * (s + 2 * y * y) + 2 * k[3] * x * y};
}

Matrix2d Distortion::jacobian(const Vector2d& ideal) const {
  const double x = ideal.x(), y = ideal.y(), s = x * x + y * y;
  if (model == DistortionModel::kEquidistant) {
    const double r = std::sqrt(s);
    if (r < kSmallestRadius) return Matrix2d::Identity();
    const Factor bent = fisheye(k, std::atan(r));
    const Vector2d along = ideal / r;
    const Matrix2d radially = along * along.transpose();
    return bent.derivative / (1 + s) * radially + bent.value / r * (Matrix2d::Identity() - radially);
  }
  const Factor f = rational(k, s);
  Matrix2d J = f.value * Matrix2d::Identity() + 2 * f.derivative * ideal * ideal.transpose();
  J(0, 0) += 2 * k[2] * y + 6 * k[3] * x;
  J(1, 1) += 6 * k[2] * y + 2 * k[3] * x;
  J(0, 1) += 2 * k[2] * x + 2 * k[3] * y;
  J(1, 0) += 2 * k[2] * x + 2 * k[3] * y;
  return J;
}

double Distortion::radial(double radius) const {
  if (model == DistortionModel::kEquidistant) return fisheye(k, std::atan(radius)).value;
  return radius * rational(k, radius * radius).value;
}

bool Distortion::grows(double angle) const {
  if (model == DistortionModel::kEquidistant) return fisheye(k, angle).derivative > 0;
  const double r = std::tan(angle), s = r * r;
  if (!(denominator(k, s) > 0)) return false;
  const Factor f = rational(k, s);
  // In the worst direction, decentring takes 3 |p| r² from the radius.
  return f.value + 2 * s * f.derivative > 6 * r * std::hypot(k[2], k[3]);
}

double Distortion::largest_radius() const {
  constexpr int kSteps = 900, kHalvings = 50;
  double good = 0, bad = kLargestAngle;
  for (int i = 1; i <= kSteps; ++i) {
    const double angle = kLargestAngle * i / kSteps;
    if (!grows(angle)) {
      bad = angle;
      break;
    }
    good = angle;
  }
  for (int i = 0; i < kHalvings && good < kLargestAngle; ++i) {
    const double middle = 0.5 * (good + bad);
    (grows(middle) ? good : bad) = middle;
  }
  return std::tan(good);
}

std::optional<Vector2d> Distortion::undistort(const Vector2d& distorted, double limit) const {
  constexpr int kHalvings = 64, kNewtonSteps = 10;
  constexpr double kClose = 1e-10;
  const double wanted = distorted.norm();
  if (!std::isfinite(wanted)) return std::nullopt;
  double low = 0, high = limit;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (radial(middle) < wanted ? low : high) = middle;
  }
  Vector2d ideal = wanted < kSmallestRadius ? distorted : Vector2d(distorted * (high / wanted));
  for (int i = 0; i < kNewtonSteps && (distort(ideal) - distorted).norm() > kClose; ++i)
    ideal -= jacobian(ideal).inverse() * (distort(ideal) - distorted);
  if (!((distort(ideal) - distorted).norm() <= kClose * (1 + wanted)) || !(ideal.norm() <= limit)) return std::nullopt;
  return ideal;
}

}  // namespace cairn::cameras
