// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "hal/image.hpp"
#include "onboard/perception/networks/model/network.hpp"

namespace cairn::networks {

/// Pictures → what a network takes in: resized with bilinear interpolation, normalised, plane by plane.
class InputTensor {
 public:
  InputTensor(const NetworkConfig& config, int width, int height);

  /// Takes a picture that is kBgr8 or kMono8 and not empty. Throws cv::Exception.
  void fill(const ImageView& picture);
  /// 1 × planes × height × width.
  [[nodiscard]] const cv::Mat& blob() const { return blob_; }
  [[nodiscard]] const Placement& placement() const { return placement_; }

 private:
  void place(const ImageView& picture);
  void normalise();

  bool letterbox_, grey_, rgb_;
  int planes_;
  double letterbox_value_;
  std::array<std::array<float, 256>, 3> normalised_{};  // by plane and value
  Placement placement_;
  cv::Mat converted_, fitted_, blob_;
};

/// Planes of the input: 1 for grey, else 3.
[[nodiscard]] int input_planes(const NetworkConfig& config);

}  // namespace cairn::networks
