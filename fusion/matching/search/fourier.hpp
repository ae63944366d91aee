// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace cairn::matching {

/// A square of complex numbers, real and imaginary parts apart, row by row.
struct ComplexImage {
  using Plane = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  explicit ComplexImage(int edge) : re(Plane::Zero(edge, edge)), im(Plane::Zero(edge, edge)) {}
  [[nodiscard]] int edge() const { return static_cast<int>(re.rows()); }

  Plane re, im;
};

/// The discrete Fourier transform in two dimensions, unnormalised: the spectrum lies transposed, at (kx, ky), and
/// inverse_fourier() takes it back to edge² times the image. The edge is a power of two. Butterflies are taken of whole
/// rows at once (Stockham's ordering), so that every operation is a long vector's.
void fourier(ComplexImage& image);
void inverse_fourier(ComplexImage& spectrum);

}  // namespace cairn::matching
