// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "hal/ports.hpp"
#include "onboard/perception/networks/answers/boxes.hpp"
#include "onboard/perception/networks/config/class_map.hpp"
#include "onboard/perception/networks/model/network.hpp"

namespace cairn::networks {

/// A network whose output is rows of YOLOX's grids, or a list as SSDs give it: see boxes.hpp.
class NetworkDetector final : public Detector {
 public:
  /// Error kInvalidConfig: the network's output does not fit `config`.
  [[nodiscard]] static Result<std::unique_ptr<NetworkDetector>> create(Network network, const NetworkConfig& config);

  Result<const Detections*> detect(const Image& picture) override;

 private:
  enum class Form : std::uint8_t { kYolox, kSsdRows, kSsdPair };
  NetworkDetector(Network network, ClassMap classes, std::vector<int> strides, BoxRules rules)
      : network_(std::move(network)), classes_(std::move(classes)), strides_(std::move(strides)), rules_(rules) {}
  [[nodiscard]] Error unfit(const std::string& expected, const std::string& remedy) const;
  Result<void> expect_yolox();
  Result<void> expect_ssd();
  void read();

  Network network_;
  ClassMap classes_;
  std::vector<int> strides_;
  BoxRules rules_;
  Form form_ = Form::kYolox;
  std::size_t scores_ = 0;  // which output of an SSD with two
  std::vector<Candidate> candidates_;
  Detections detections_;
};

}  // namespace cairn::networks
