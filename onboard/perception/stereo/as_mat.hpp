// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "hal/image.hpp"

namespace cairn::stereo {

/// OpenCV's header for an image's memory (kMono8, kBgr8). It must not be written through.
inline cv::Mat as_mat(const Image& image) {
  const int type = image.format == PixelFormat::kBgr8 ? CV_8UC3 : CV_8UC1;
  return {image.height, image.width, type, const_cast<std::byte*>(image.bytes.data()), image.stride};
}

/// The same for an image that is filled through it.
inline cv::Mat as_mat(Image& image) { return as_mat(static_cast<const Image&>(image)); }

}  // namespace cairn::stereo
