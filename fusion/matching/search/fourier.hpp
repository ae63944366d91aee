// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace cairn::matching {

/// A square of complex numbers, row by row, with real and imaginary parts apart.
struct ComplexImage {
  using Plane = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  explicit ComplexImage(int edge) : re(Plane::Zero(edge, edge)), im(Plane::Zero(edge, edge)) {}
  [[nodiscard]] int edge() const { return static_cast<int>(re.rows()); }

  Plane re, im;
};

/// The discrete Fourier transform in two dimensions, in place and unnormalised. The edge must be a
/// power of two. The spectrum lies transposed, at (kx, ky). inverse_fourier() gives edge² times the
/// image. Whole rows are combined at once (Stockham's ordering), so that the compiler can
/// vectorise.
void fourier(ComplexImage& image);
void inverse_fourier(ComplexImage& spectrum);

}  // namespace cairn::matching
