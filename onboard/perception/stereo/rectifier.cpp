// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/rectifier.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

#include "onboard/perception/stereo/as_mat.hpp"

namespace cairn::stereo {
namespace {

bool distorts(const cameras::Distortion& distortion) {
  return distortion.model == cameras::DistortionModel::kEquidistant ||
         std::ranges::any_of(distortion.k, [](double k) { return k != 0; });
}

void grey(const cv::Mat& picture, cv::Mat& out) {
  if (picture.channels() == 3) {
    cv::cvtColor(picture, out, cv::COLOR_BGR2GRAY);
  } else {
    picture.copyTo(out);
  }
}

std::string size_of(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

}  // namespace

struct Rectifier::Maps {
  cv::Mat x, y;
};

Result<Rectifier> Rectifier::create(const cameras::CameraModel& eye, double baseline_m, double line_time_s) {
  if (!(baseline_m > 0))
    return Error{Errc::kInvalidConfig,
                 "the distance between the eyes of the stereo camera is not known",
                 {},
                 {},
                 "set camera.intrinsics.baseline_m"};
  const cameras::CameraParameters& p = eye.parameters();
  const StereoGeometry geometry{p.width, p.height, p.fx, p.fy, p.cx, p.cy, baseline_m, line_time_s};
  if (!distorts(p.distortion)) return Rectifier(geometry, nullptr);
  auto maps = std::make_shared<Maps>(Maps{cv::Mat(p.height, p.width, CV_32FC1), cv::Mat(p.height, p.width, CV_32FC1)});
  for (int v = 0; v < p.height; ++v)
    for (int u = 0; u < p.width; ++u) {
      const Eigen::Vector2d seen = p.distortion.distort({(u - p.cx) / p.fx, (v - p.cy) / p.fy});
      maps->x.at<float>(v, u) = static_cast<float>(p.fx * seen.x() + p.cx);
      maps->y.at<float>(v, u) = static_cast<float>(p.fy * seen.y() + p.cy);
    }
  return Rectifier(geometry, std::move(maps));
}

Result<void> Rectifier::rectify(const Image& both, StereoPair& pair) const {
  const int width = geometry_.width, height = geometry_.height;
  if (both.width != 2 * width || both.height != height)
    return Error{Errc::kMalformed,
                 "the stereo picture has another size than its calibration",
                 {},
                 {},
                 size_of(both.width, both.height) + " came, and two eyes of " + size_of(width, height) +
                     " side by side are calibrated"};
  if (both.format != PixelFormat::kBgr8 && both.format != PixelFormat::kMono8)
    return Error{Errc::kMalformed, "the stereo picture is neither coloured nor grey", {}, {}, {}};
  pair.stamp = pair.left.stamp = pair.right.stamp = both.stamp;
  const cv::Mat whole = as_mat(both);
  for (const int eye : {0, 1}) {
    Image& image = eye == 0 ? pair.left : pair.right;
    image.resize(PixelFormat::kMono8, width, height);
    cv::Mat out = as_mat(image);
    const cv::Mat seen = whole.colRange(eye * width, (eye + 1) * width);
    if (maps_ == nullptr) {
      grey(seen, out);
      continue;
    }
    cv::Mat bent;
    grey(seen, bent);
    cv::remap(bent, out, maps_->x, maps_->y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  }
  return {};
}

}  // namespace cairn::stereo
