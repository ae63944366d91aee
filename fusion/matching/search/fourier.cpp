// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/fourier.hpp"

#include <cmath>
#include <utility>

namespace cairn::matching {
namespace {

/// Row 2jm + k and the next but m of `to` from rows jm + k and lm further of `from`, l·m being half
/// of the rows.
void butterfly(const ComplexImage& from, ComplexImage& to, int in, int half, int out, int m, double angle) {
  const auto re = static_cast<float>(std::cos(angle)), im = static_cast<float>(std::sin(angle));
  to.re.row(out) = from.re.row(in) + from.re.row(in + half);
  to.im.row(out) = from.im.row(in) + from.im.row(in + half);
  to.re.row(out + m) =
      re * (from.re.row(in) - from.re.row(in + half)) - im * (from.im.row(in) - from.im.row(in + half));
  to.im.row(out + m) =
      re * (from.im.row(in) - from.im.row(in + half)) + im * (from.re.row(in) - from.re.row(in + half));
}

void transform_columns(ComplexImage& image, ComplexImage& other) {
  const int n = image.edge();
  for (int l = n / 2, m = 1; l >= 1; l /= 2, m *= 2) {
    for (int j = 0; j < l; ++j)
      for (int k = 0; k < m; ++k) butterfly(image, other, j * m + k, n / 2, 2 * j * m + k, m, -M_PI * j / l);
    std::swap(image, other);
  }
}

/// Square by square, so that each fits into the cache.
void transpose(ComplexImage& image, ComplexImage& other) {
  constexpr int kSquare = 16;  // pixels: a row of floats is one cache line of 64 bytes
  const int n = image.edge();
  for (int y = 0; y < n; y += kSquare)
    for (int x = 0; x < n; x += kSquare) {
      const int h = std::min(kSquare, n - y), w = std::min(kSquare, n - x);
      other.re.block(x, y, w, h) = image.re.block(y, x, h, w).transpose();
      other.im.block(x, y, w, h) = image.im.block(y, x, h, w).transpose();
    }
  std::swap(image, other);
}

}  // namespace

void fourier(ComplexImage& image) {
  ComplexImage other(image.edge());
  transform_columns(image, other);
  transpose(image, other);
  transform_columns(image, other);
}

void inverse_fourier(ComplexImage& spectrum) {
  std::swap(spectrum.re, spectrum.im);
  fourier(spectrum);
  std::swap(spectrum.re, spectrum.im);
}

}  // namespace cairn::matching
