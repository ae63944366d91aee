// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/fourier.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <random>

namespace cairn::matching {
namespace {

ComplexImage random_image(int edge, unsigned seed) {
  std::mt19937 random(seed);
  ComplexImage image(edge);
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) {
      image.re(y, x) = static_cast<float>(random() % 1000) * 1e-3F;
      image.im(y, x) = static_cast<float>(random() % 1000) * 1e-3F;
    }
  return image;
}

TEST(Fourier, IsTheSumItStandsFor) {
  for (const int n : {1, 2, 4, 16}) {
    const ComplexImage image = random_image(n, 1);
    ComplexImage spectrum = image;
    fourier(spectrum);
    for (int ky = 0; ky < n; ++ky)
      for (int kx = 0; kx < n; ++kx) {
        std::complex<double> sum = 0;
        for (int y = 0; y < n; ++y)
          for (int x = 0; x < n; ++x)
            sum += std::polar(1.0, -2 * M_PI * (kx * x + ky * y) / n) *
                   std::complex<double>(double(image.re(y, x)), double(image.im(y, x)));
        EXPECT_NEAR(double(spectrum.re(kx, ky)), sum.real(), 1e-3);
        EXPECT_NEAR(double(spectrum.im(kx, ky)), sum.imag(), 1e-3);
      }
  }
}

TEST(Fourier, InverseTakesItBack) {
  const ComplexImage image = random_image(64, 2);
  ComplexImage there = image;
  fourier(there);
  inverse_fourier(there);
  EXPECT_LT((there.re / 4096 - image.re).abs().maxCoeff(), 1e-5F);
  EXPECT_LT((there.im / 4096 - image.im).abs().maxCoeff(), 1e-5F);
}

}  // namespace
}  // namespace cairn::matching
