// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/model/input_tensor.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace cairn::networks {
namespace {

/// The pixels without a copy; OpenCV only reads them.
cv::Mat matrix_of(const ImageView& picture) {
  const int type = picture.format == PixelFormat::kBgr8 ? CV_8UC3 : CV_8UC1;
  auto* data = const_cast<std::byte*>(picture.bytes.data());
  return {picture.height, picture.width, type, data, picture.stride};
}

}  // namespace

int input_planes(const NetworkConfig& config) { return config.channels == "grey" ? 1 : 3; }

InputTensor::InputTensor(const NetworkConfig& config, int width, int height)
    : letterbox_(config.fit == "letterbox"),
      grey_(config.channels == "grey"),
      rgb_(config.channels == "rgb"),
      planes_(input_planes(config)),
      letterbox_value_(config.letterbox_value) {
  for (std::size_t plane = 0; plane < normalised_.size(); ++plane)
    for (std::size_t x = 0; x < 256; ++x)
      normalised_[plane][x] =
          static_cast<float>((static_cast<double>(x) - config.mean[plane]) / config.std[plane] / config.divisor);
  placement_.input_width = width;
  placement_.input_height = height;
  const int shape[] = {1, planes_, height, width};
  blob_.create(4, shape, CV_32F);
  fitted_.create(height, width, grey_ ? CV_8UC1 : CV_8UC3);
}

void InputTensor::place(const ImageView& picture) {
  Placement& p = placement_;
  p.picture_width = picture.width;
  p.picture_height = picture.height;
  cv::Size size(p.input_width, p.input_height);
  if (letterbox_) {
    const double scale = std::min(static_cast<double>(p.input_width) / picture.width,
                                  static_cast<double>(p.input_height) / picture.height);
    size.width = std::clamp(static_cast<int>(picture.width * scale), 1, p.input_width);
    size.height = std::clamp(static_cast<int>(picture.height * scale), 1, p.input_height);
  }
  p.scale_x = static_cast<double>(size.width) / picture.width;
  p.scale_y = static_cast<double>(size.height) / picture.height;
  fitted_.setTo(cv::Scalar::all(letterbox_value_));
  cv::Mat part = fitted_(cv::Rect(cv::Point(0, 0), size));
  cv::resize(converted_, part, size, 0, 0, cv::INTER_LINEAR);
}

void InputTensor::fill(const ImageView& picture) {
  const cv::Mat given = matrix_of(picture);
  const bool colour = picture.format == PixelFormat::kBgr8;
  if (grey_ && colour)
    cv::cvtColor(given, converted_, cv::COLOR_BGR2GRAY);
  else if (!grey_ && !colour)
    cv::cvtColor(given, converted_, cv::COLOR_GRAY2BGR);
  else
    converted_ = given;
  place(picture);
  converted_.release();  // it may be the caller's memory
  normalise();
}

void InputTensor::normalise() {
  const auto width = static_cast<std::size_t>(placement_.input_width);
  const auto planes = static_cast<std::size_t>(planes_);
  for (int y = 0; y < placement_.input_height; ++y) {
    const uchar* row = fitted_.ptr(y);
    for (std::size_t plane = 0; plane < planes; ++plane) {
      const std::size_t channel = rgb_ ? planes - 1 - plane : plane;
      float* out = blob_.ptr<float>(0, static_cast<int>(plane)) + static_cast<std::size_t>(y) * width;
      for (std::size_t x = 0; x < width; ++x) out[x] = normalised_[plane][row[x * planes + channel]];
    }
  }
}

}  // namespace cairn::networks
