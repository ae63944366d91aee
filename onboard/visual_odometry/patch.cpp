// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/patch.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace cairn::visual_odometry {
namespace {

constexpr int kMostSteps = 10;
constexpr float kStill_px = 0.01F;           // a smaller step ends the search
constexpr float kFarthest_px = 2.0F;         // from where the search begins
constexpr float kLeastSpread = 1.5F;         // grey levels, standard deviation of a patch
constexpr float kLeastCorrelation = 0.6F;    // of the patch with what is seen
constexpr float kMostScale = 2.0F;           // a patch that is seen so much larger or smaller shows other detail
constexpr double kLeastDeterminacy = 1e-10;  // of the normal equations, as Eigen's threshold

constexpr int kLanes = 16;  // the first multiple of four with room for kEdge
using Lanes = Eigen::Array<float, kLanes, 1>;

Eigen::Vector2f offset(int i) {
  return {static_cast<float>(i % Patch::kEdge - Patch::kReach), static_cast<float>(i / Patch::kEdge - Patch::kReach)};
}

/// Whether all of the patch lies in the picture.
bool within(const cv::Mat& picture, const PatchPose& pose) {
  const Eigen::Vector2f reach = Patch::kReach * pose.warp.cwiseAbs().rowwise().sum();
  const Eigen::Vector2f least = pose.middle - reach, most = pose.middle + reach;
  return least.minCoeff() >= 0 && most.x() < static_cast<float>(picture.cols - 1) &&
         most.y() < static_cast<float>(picture.rows - 1);
}

}  // namespace

std::optional<Patch> Patch::cut(const cv::Mat& picture, const Eigen::Vector2f& middle) {
  constexpr int kWide = kEdge + 2;  // a pixel more on each side, for the gradient
  const float reach = kReach + 1;
  const cv::Rect2f inner(reach, reach, static_cast<float>(picture.cols) - 1 - 2 * reach,
                         static_cast<float>(picture.rows) - 1 - 2 * reach);
  if (!inner.contains({middle.x(), middle.y()})) return std::nullopt;
  cv::Mat wide;
  cv::getRectSubPix(picture, {kWide, kWide}, {middle.x(), middle.y()}, wide, CV_32F);
  Patch patch;
  for (int i = 0; i < kPixels; ++i) patch.value_[i] = wide.at<float>(1 + i / kEdge, 1 + i % kEdge);
  patch.value_.array() -= patch.value_.mean();
  if (patch.value_.norm() < kLeastSpread * kEdge) return std::nullopt;
  for (int i = 0; i < kPixels; ++i) {
    const int row = 1 + i / kEdge, column = 1 + i % kEdge;
    const float gx = 0.5F * (wide.at<float>(row, column + 1) - wide.at<float>(row, column - 1));
    const float gy = 0.5F * (wide.at<float>(row + 1, column) - wide.at<float>(row - 1, column));
    const Eigen::Vector2f p = offset(i);
    patch.derivative_.col(i) << gx * p, gy * p, gx, gy, patch.value_[i], 1.0F;
  }
  const Eigen::Matrix<double, kNumbers, kPixels> derivative = patch.derivative_.cast<double>();
  Eigen::FullPivLU<Eigen::Matrix<double, kNumbers, kNumbers>> equations(derivative * derivative.transpose());
  equations.setThreshold(kLeastDeterminacy);
  if (!equations.isInvertible()) return std::nullopt;
  patch.uncertainty_ = equations.inverse().cast<float>();
  return patch;
}

/// Between four pixels each, a row of the patch at a time.
bool Patch::sample(const cv::Mat& picture, const PatchPose& pose, Values& values) {
  if (!within(picture, pose)) return false;
  const Lanes along = Lanes::LinSpaced(-kReach, kLanes - 1 - kReach).min(static_cast<float>(kReach));
  const Lanes dx = along * pose.warp(0, 0), dy = along * pose.warp(1, 0);
  const auto* pixels = picture.ptr<unsigned char>();
  const auto stride = static_cast<int>(picture.step);
  Lanes a, b, c, d;
  for (int row = 0; row < kEdge; ++row) {
    const Eigen::Vector2f begin = pose.middle + static_cast<float>(row - kReach) * pose.warp.col(1);
    const Lanes x = begin.x() + dx, y = begin.y() + dy;
    const Eigen::Array<int, kLanes, 1> column = x.cast<int>(), line = y.cast<int>(), first = line * stride + column;
    for (int i = 0; i < kLanes; ++i) {
      const unsigned char* upper = pixels + first[i];
      a[i] = upper[0];
      b[i] = upper[1];
      c[i] = upper[stride];
      d[i] = upper[stride + 1];
    }
    const Lanes right = x - column.cast<float>(), down = y - line.cast<float>();
    const Lanes top = a + right * (b - a), bottom = c + right * (d - c);
    values.segment<kEdge>(row * kEdge) = (top + down * (bottom - top)).head<kEdge>();
  }
  return true;
}

/// Of warp, middle, gain and offset, by which what is seen differs from the patch.
Patch::Numbers Patch::step(const Values& seen) const {
  const Values difference = seen - value_;
  Numbers sum = Numbers::Zero();
  for (int i = 0; i < kPixels; ++i) sum += difference[i] * derivative_.col(i);
  return uncertainty_ * sum;
}

bool Patch::looks_like(const Values& seen) const {
  const Values even = seen.array() - seen.mean();
  return even.dot(value_) > kLeastCorrelation * std::max(even.norm(), kLeastSpread) * value_.norm();
}

std::optional<PatchPose> Patch::find(const cv::Mat& picture, const PatchPose& start) const {
  PatchPose pose = start;
  Values seen;
  for (int steps = 0; steps < kMostSteps; ++steps) {
    if (!sample(picture, pose, seen)) return std::nullopt;
    const Numbers d = step(seen);
    Eigen::Matrix2f change;
    change << 1 + d[0], d[1], d[2], 1 + d[3];
    const Eigen::Matrix2f back = change.inverse();
    pose.middle -= pose.warp * back * d.segment<2>(4);
    pose.warp = pose.warp * back;
    const float scale = std::sqrt(std::abs(pose.warp.determinant()));
    const bool sane =
        (pose.middle - start.middle).norm() < kFarthest_px && scale < kMostScale && scale > 1 / kMostScale;
    if (!sane) return std::nullopt;  // not a number is not sane either
    if (d.segment<2>(4).norm() < kStill_px) return looks_like(seen) ? std::optional(pose) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace cairn::visual_odometry
