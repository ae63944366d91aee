// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hal/ports.hpp"
#include "onboard/perception/networks/config/class_map.hpp"
#include "onboard/perception/networks/model/network.hpp"

namespace cairn::networks {

/// A network whose output is one plane of numbers per class: 1 × classes × height × width.
class NetworkSegmenter final : public Segmenter {
 public:
  /// Error kInvalidConfig: the network's output does not fit `config`.
  [[nodiscard]] static Result<std::unique_ptr<NetworkSegmenter>> create(Network network, const NetworkConfig& config);

  Result<const LabelImage*> segment(const Image& picture) override;

 private:
  NetworkSegmenter(Network network, ClassMap classes) : network_(std::move(network)), classes_(std::move(classes)) {}

  Network network_;
  ClassMap classes_;
  LabelImage labels_;
};

}  // namespace cairn::networks
