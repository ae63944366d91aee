// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <span>
#include <vector>

#include "hal/files/file.hpp"

namespace cairn::app::test {

/// A grey picture, row by row.
inline void write_png(const std::filesystem::path& file, int width, int height, const std::vector<std::byte>& grey) {
  const cv::Mat pixels(height, width, CV_8UC1, const_cast<std::byte*>(grey.data()));
  std::vector<uchar> out;
  ASSERT_TRUE(cv::imencode(".png", pixels, out));
  ASSERT_TRUE(write_file_atomic(file, std::as_bytes(std::span(out))));
}

}  // namespace cairn::app::test
