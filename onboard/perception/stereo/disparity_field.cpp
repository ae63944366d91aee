// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/disparity_field.hpp"

#include <Eigen/Core>

namespace cairn::stereo {
namespace {

constexpr int kEdge = 2 * DisparityField::kReach + 1;
constexpr int kLanes = 12;             // the first multiple of four with room for kEdge
constexpr int kFits = 2;               // with the gate proper; chosen by hand, not tuned
constexpr float kRoughGate = 1.2F;     // pixels, while the plane's slope is not known; chosen by hand, not tuned
constexpr float kLeastSpread = 1e-3F;  // added to squared samples: a row of samples has no slope across

using Lanes = Eigen::Array<float, kLanes, 1>;

}  // namespace

/// Disparity at the sample, and its change per sample.
struct DisparityField::Plane {
  float middle = 0, per_column = 0, per_row = 0;
};

/// Weighted sums over the samples, of column c and row r from the middle, and of disparity d.
struct DisparityField::Sums {
  float n = 0, c = 0, r = 0, d = 0, cc = 0, cr = 0, rr = 0, cd = 0, rd = 0;

  [[nodiscard]] Plane plane() const {
    const float xx = cc - c * c / n + kLeastSpread, xy = cr - c * r / n, yy = rr - r * r / n + kLeastSpread;
    const float xd = cd - c * d / n, yd = rd - r * d / n, det = xx * yy - xy * xy;
    const float a = (yy * xd - xy * yd) / det, b = (xx * yd - xy * xd) / det;
    return {(d - a * c - b * r) / n, a, b};
  }
};

void DisparityField::reset(int columns, int rows) {
  columns_ = columns;
  rows_ = rows;
  stride_ = static_cast<std::size_t>(columns + kLanes);
  values_.assign(stride_ * static_cast<std::size_t>(rows + 2 * kReach), kNothing);
}

/// A column's sums are independent of the others', so four columns are added at a time. Lanes beyond kEdge are not
/// used.
DisparityField::Sums DisparityField::sum(int column, int row, const Plane& plane, float gate) const {
  const Lanes x = Lanes::LinSpaced(-kReach, kLanes - 1 - kReach);
  const float per_square = 1 / (gate * gate);
  Lanes n = Lanes::Zero(), r = n, rr = n, d = n, rd = n;
  for (int j = 0; j < kEdge; ++j) {
    const Eigen::Map<const Lanes> value(&values_[index(column - kReach, row - kReach + j)]);
    const auto y = static_cast<float>(j - kReach);
    const Lanes off = value - (plane.middle + y * plane.per_row + plane.per_column * x);
    const Lanes weight = (1 - per_square * off * off).max(0.0F);
    const Lanes weighted = weight * value;
    n += weight;
    r += y * weight;
    rr += y * y * weight;
    d += weighted;
    rd += y * weighted;
  }
  Sums s;
  for (int i = 0; i < kEdge; ++i) {
    s.n += n[i];
    s.c += x[i] * n[i];
    s.r += r[i];
    s.d += d[i];
    s.cc += x[i] * x[i] * n[i];
    s.cr += x[i] * r[i];
    s.rr += rr[i];
    s.cd += x[i] * d[i];
    s.rd += rd[i];
  }
  return s;
}

std::optional<double> DisparityField::on_plane(int column, int row, double gate_px, int least) const {
  Plane plane{values_[index(column, row)], 0, 0};
  if (plane.middle == kNothing) return std::nullopt;
  for (int fit = 0; fit <= kFits; ++fit) {
    const Sums s = sum(column, row, plane, fit == 0 ? kRoughGate : static_cast<float>(gate_px));
    if (s.n < static_cast<float>(least)) return std::nullopt;
    plane = s.plane();
  }
  return plane.middle > 0 ? std::optional(static_cast<double>(plane.middle)) : std::nullopt;
}

}  // namespace cairn::stereo
