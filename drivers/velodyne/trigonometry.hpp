// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace cairn::velodyne {

/// Sine and cosine of one angle.
struct SinCos {
  double sin = 0, cos = 1;
};

/// Sine and cosine of |radians| <= π/4 to within 2e-16.
///
/// An own series, because the C library chooses its sin() by processor (with or without FMA), and points must have the
/// same bits on every machine.
[[nodiscard]] constexpr SinCos sin_cos_series(double radians) {
  const double q = radians * radians;
  const auto nest = [q](double next, int n, int m) { return 1 - q * (1.0 / (n * m)) * next; };
  const double s =
      nest(nest(nest(nest(nest(nest(nest(nest(1, 16, 17), 14, 15), 12, 13), 10, 11), 8, 9), 6, 7), 4, 5), 2, 3);
  const double c =
      nest(nest(nest(nest(nest(nest(nest(nest(1, 15, 16), 13, 14), 11, 12), 9, 10), 7, 8), 5, 6), 3, 4), 1, 2);
  return {radians * s, c};
}

/// Sine and cosine of any angle with |degrees| < 1e6. Exact at multiples of 90°.
[[nodiscard]] inline SinCos sin_cos_deg(double degrees) {
  const double quarter = std::floor(degrees / 90.0 + 0.5);
  const SinCos r = sin_cos_series((degrees - 90.0 * quarter) * (std::numbers::pi / 180.0));
  switch (static_cast<std::int64_t>(quarter) & 3) {
    case 0:
      return r;
    case 1:
      return {r.cos, -r.sin};
    case 2:
      return {-r.sin, -r.cos};
    default:
      return {-r.cos, r.sin};
  }
}

/// Sine and cosine of |radians| < 0.02 (the rotation within one firing), to within 1e-16.
[[nodiscard]] constexpr SinCos sin_cos_small(double radians) {
  const double q = radians * radians;
  return {radians * (1 - q * (1.0 / 6) * (1 - q * (1.0 / 20))),
          1 - q * 0.5 * (1 - q * (1.0 / 12) * (1 - q * (1.0 / 30)))};
}

/// The same direction in [0, 360). `degrees` is finite.
[[nodiscard]] inline double wrap_360(double degrees) {
  const double wrapped = degrees - 360.0 * std::floor(degrees / 360.0);
  return wrapped < 360.0 ? wrapped : 0.0;  // a tiny negative angle rounds up to 360
}

}  // namespace cairn::velodyne
