// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/corner_detector.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace cairn::visual_odometry {
namespace {

/// The product of two gradients in each column, summed over three columns. The first and the last are left out.
void sum_products(const short* a, const short* b, int width, std::vector<float>& products, std::vector<float>& sums) {
  products.resize(static_cast<std::size_t>(width));
  sums.resize(static_cast<std::size_t>(width));
  float* p = products.data();
  float* s = sums.data();
  for (int x = 0; x < width; ++x) p[x] = static_cast<float>(a[x]) * static_cast<float>(b[x]);
  for (int x = 1; x + 1 < width; ++x) s[x] = p[x - 1] + p[x] + p[x + 1];
}

/// Marks what is nearer than `spacing` to `middle`.
void forbid_around(const cv::Point& middle, int spacing, cv::Mat& allowed) {
  for (int dy = 1 - spacing; dy < spacing; ++dy) {
    const int y = middle.y + dy;
    if (y < 0 || y >= allowed.rows) continue;
    int reach = spacing - 1;
    while (reach * reach + dy * dy >= spacing * spacing) --reach;
    const int from = std::max(middle.x - reach, 0), to = std::min(middle.x + reach + 1, allowed.cols);
    std::fill(allowed.ptr(y) + from, allowed.ptr(y) + to, static_cast<unsigned char>(0));
  }
}

/// Sorts by response, then by row and column. Positive numbers have the order of their bits.
std::uint64_t candidate(float response, int x, int y) {
  const std::uint64_t at = static_cast<std::uint64_t>(y) << 16U | static_cast<std::uint64_t>(x);
  return static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(response)) << 32U | at;
}
cv::Point place_of(std::uint64_t candidate) {
  return {static_cast<int>(candidate & 0xFFFFU), static_cast<int>(candidate >> 16U & 0xFFFFU)};
}

}  // namespace

void CornerDetector::add_row(int y) {
  Moments& row = rows_[y % 3];
  const short* gx = along_x_.ptr<short>(y);
  const short* gy = along_y_.ptr<short>(y);
  sum_products(gx, gx, along_x_.cols, products_, row.xx);
  sum_products(gx, gy, along_x_.cols, products_, row.xy);
  sum_products(gy, gy, along_x_.cols, products_, row.yy);
}

/// The smaller eigenvalue, times two, of the moments of three rows.
void CornerDetector::respond_in_row(int y) {
  const Moments &a = rows_[(y + 2) % 3], &b = rows_[y % 3], &c = rows_[(y + 1) % 3];
  const float *axx = a.xx.data(), *bxx = b.xx.data(), *cxx = c.xx.data();
  const float *axy = a.xy.data(), *bxy = b.xy.data(), *cxy = c.xy.data();
  const float *ayy = a.yy.data(), *byy = b.yy.data(), *cyy = c.yy.data();
  float* out = response_.ptr<float>(y);
  for (int x = 1; x + 1 < response_.cols; ++x) {
    const float xx = axx[x] + bxx[x] + cxx[x], xy = axy[x] + bxy[x] + cxy[x], yy = ayy[x] + byy[x] + cyy[x];
    const float half = xx - yy;
    out[x] = xx + yy - std::sqrt(half * half + 4 * xy * xy);
  }
}

void CornerDetector::respond(const cv::Mat& picture) {
  cv::spatialGradient(picture, along_x_, along_y_);
  response_.create(picture.size(), CV_32F);
  response_.setTo(0);
  add_row(0);
  add_row(1);
  for (int y = 1; y + 1 < picture.rows; ++y) {
    add_row(y + 1);
    respond_in_row(y);
  }
}

float CornerDetector::strongest(const cv::Mat& allowed) const {
  float most = 0;
  for (int y = 0; y < response_.rows; ++y) {
    const float* r = response_.ptr<float>(y);
    const unsigned char* may = allowed.ptr(y);
    for (int x = 0; x < response_.cols; ++x) most = std::max(most, may[x] != 0 ? r[x] : 0.0F);
  }
  return most;
}

/// The local maxima, as far as they are strong enough.
void CornerDetector::collect(const cv::Mat& allowed, float least) {
  const int width = response_.cols;
  candidates_.clear();
  column_most_.resize(static_cast<std::size_t>(width));
  peak_.assign(static_cast<std::size_t>(width), 0);
  for (int y = 1; y + 1 < response_.rows; ++y) {
    const float *above = response_.ptr<float>(y - 1), *r = response_.ptr<float>(y),
                *below = response_.ptr<float>(y + 1);
    const unsigned char* may = allowed.ptr(y);
    float* most = column_most_.data();
    unsigned char* peak = peak_.data();
    for (int x = 0; x < width; ++x) most[x] = std::max(std::max(above[x], r[x]), below[x]);
    for (int x = 1; x + 1 < width; ++x) {  // without branches: most pixels are none, in no order
      const float around = std::max(std::max(most[x - 1], most[x]), most[x + 1]);
      peak[x] = static_cast<unsigned char>(static_cast<int>(r[x] >= around) & static_cast<int>(r[x] > least) &
                                           static_cast<int>(may[x] != 0));
    }
    for (int x = 1; x + 1 < width; ++x)
      if (peak[x] != 0) candidates_.push_back(candidate(r[x], x, y));
  }
  std::ranges::sort(candidates_, std::ranges::greater{});
}

std::vector<cv::Point> CornerDetector::find(const cv::Mat& picture, const cv::Mat& allowed,
                                            const CornerConfig& config) {
  std::vector<cv::Point> corners;
  respond(picture);
  collect(allowed, static_cast<float>(config.quality) * strongest(allowed));
  cv::Mat left = allowed.clone();
  for (const std::uint64_t c : candidates_) {
    if (static_cast<int>(corners.size()) >= config.most) break;
    const cv::Point at = place_of(c);
    if (left.at<unsigned char>(at) == 0) continue;
    corners.push_back(at);
    forbid_around(at, config.spacing_px, left);
  }
  return corners;
}

}  // namespace cairn::visual_odometry
