// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/dense_stereo.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "onboard/perception/stereo/as_mat.hpp"
#include "onboard/perception/stereo/disparity_refiner.hpp"

namespace cairn::stereo {
namespace {

constexpr int kCoarser = 2;            // the search sees pictures of half the size, which is four times as fast
constexpr int kSteps = 16;             // OpenCV's disparities, in a pixel
constexpr int kSpeckleRange = 2;       // pixels between neighbours of one island
constexpr int kLeftRight_px = 1;       // both directions of the search must agree this well
constexpr int kLargestGradient = 31;   // of the filter before the comparison
constexpr double kSearchError_px = 1;  // of what the search finds

}  // namespace

struct DenseStereo::Matcher {
  cv::Ptr<cv::StereoSGBM> search;
  cv::Mat small_left, small_right, disparity;
};

DenseStereo::DenseStereo(const DenseStereoConfig& config, const StereoGeometry& geometry)
    : config_(config), geometry_(geometry), matcher_(std::make_unique<Matcher>()) {
  const int area = config.block_px * config.block_px;
  matcher_->search =
      cv::StereoSGBM::create(0, (config.disparities / kCoarser + 15) / 16 * 16, config.block_px, 8 * area, 32 * area,
                             kLeftRight_px, kLargestGradient, config.uniqueness_percent,
                             config.speckle_px / (kCoarser * kCoarser), kSpeckleRange, cv::StereoSGBM::MODE_SGBM_3WAY);
}

DenseStereo::DenseStereo(DenseStereo&&) noexcept = default;
DenseStereo& DenseStereo::operator=(DenseStereo&&) noexcept = default;
DenseStereo::~DenseStereo() = default;

/// None where nothing was found, or at an edge between near and far.
std::optional<DisparityStart> DenseStereo::start_at(int x, int y) const {
  const int column = x / kCoarser, row = y / kCoarser;
  if (column < 1 || row < 1 || column + 1 >= matcher_->disparity.cols || row + 1 >= matcher_->disparity.rows)
    return std::nullopt;
  const auto at = [&](int i, int j) {
    return kCoarser * static_cast<double>(matcher_->disparity.at<std::int16_t>(row + j, column + i)) / kSteps;
  };
  const double here = at(0, 0), left = at(-1, 0), right = at(1, 0), above = at(0, -1), below = at(0, 1);
  if (here < 1) return std::nullopt;
  for (const double neighbour : {left, right, above, below})
    if (std::abs(neighbour - here) > config_.max_jump_px) return std::nullopt;
  return DisparityStart{x, y, here, (right - left) / 4, (below - above) / 4};
}

void DenseStereo::search(const StereoPair& pair) {
  cv::resize(as_mat(pair.left), matcher_->small_left, {}, 1.0 / kCoarser, 1.0 / kCoarser, cv::INTER_AREA);
  cv::resize(as_mat(pair.right), matcher_->small_right, {}, 1.0 / kCoarser, 1.0 / kCoarser, cv::INTER_AREA);
  matcher_->search->compute(matcher_->small_left, matcher_->small_right, matcher_->disparity);
}

void DenseStereo::refine(const StereoPair& pair, double least_px) {
  const auto samples = [&](int pixels) { return (pixels - 2 * kFirst_px + config_.stride_px - 1) / config_.stride_px; };
  field_.reset(samples(geometry_.width), samples(geometry_.height));
  const cv::Mat left = as_mat(pair.left), right = as_mat(pair.right);
  const DisparityRefiner refiner(left, right);
  for (int row = 0; row < field_.rows(); ++row)
    for (int column = 0; column < field_.columns(); ++column) {
      const auto start = start_at(pixel(column), pixel(row));
      if (!start || start->disparity < least_px - kSearchError_px) continue;
      if (const auto disparity = refiner.refine(*start)) field_.set(column, row, *disparity);
    }
}

void DenseStereo::measure(const StereoPair& pair, double max_range_m, std::vector<Eigen::Vector3f>& points) {
  points.clear();
  const double least_px = geometry_.fx * geometry_.baseline_m / max_range_m;
  search(pair);
  refine(pair, least_px);
  for (int row = 0; row < field_.rows(); ++row)
    for (int column = 0; column < field_.columns(); ++column) {
      const auto disparity = field_.on_plane(column, row, config_.plane_gate_px, config_.plane_points);
      if (disparity && *disparity >= least_px)
        points.emplace_back(geometry_.point(pixel(column), pixel(row), *disparity).cast<float>());
    }
}

void declare(config::Section& s, DenseStereoConfig& c) {
  s.integer("disparities", c.disparities, {16, 512}, "pixels", "that are searched; made a multiple of 16");
  s.integer("block_px", c.block_px, {3, 15}, "pixels", "edge of the blocks that are compared; odd");
  s.integer("uniqueness_percent", c.uniqueness_percent, {0, 50}, "%",
            "the best match must be so much better than the second");
  s.integer("speckle_px", c.speckle_px, {0, 5000}, "pixels", "smaller islands of equal depth are left out");
  s.integer("stride_px", c.stride_px, {1, 16}, "pixels", "every so many pixels become a point");
  s.number("max_jump_px", c.max_jump_px, {0.2, 100}, "pixels", "points where the disparity jumps more are left out");
  s.number("plane_gate_px", c.plane_gate_px, {0.05, 10}, "pixels",
           "a point's neighbours on its plane are nearer to it");
  s.integer("plane_points", c.plane_points, {1, 81}, "",
            "a point is left out where fewer of the 81 around it are on its plane");
}

}  // namespace cairn::stereo
