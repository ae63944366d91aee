// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/open_networks.hpp"

#include <utility>

#include "onboard/perception/networks/answers/network_detector.hpp"
#include "onboard/perception/networks/answers/network_segmenter.hpp"

namespace cairn::networks {
namespace {

template <class Port, class Kind>
Result<std::unique_ptr<Port>> open(const NetworkConfig& config, std::span<const std::filesystem::path> folders,
                                   NetworkFacts* facts) {
  auto network = Network::load(config, folders);
  if (!network) return network.error();
  if (facts != nullptr) *facts = network->facts();
  auto made = Kind::create(std::move(*network), config);
  if (!made) return made.error();
  return std::unique_ptr<Port>(std::move(*made));
}

Error wrong_family(const NetworkConfig& config, const char* expected) {
  return {Errc::kInvalidConfig,
          "this family of networks does something else",
          config.model,
          {},
          std::string("expected the family ") + expected + ", found " + config.family};
}

}  // namespace

Result<std::unique_ptr<Segmenter>> open_segmenter(const NetworkConfig& config,
                                                  std::span<const std::filesystem::path> folders, NetworkFacts* facts) {
  if (config.family != "logits") return wrong_family(config, "logits");
  return open<Segmenter, NetworkSegmenter>(config, folders, facts);
}

Result<std::unique_ptr<Detector>> open_detector(const NetworkConfig& config,
                                                std::span<const std::filesystem::path> folders, NetworkFacts* facts) {
  if (config.family != "yolox" && config.family != "ssd") return wrong_family(config, "yolox or ssd");
  return open<Detector, NetworkDetector>(config, folders, facts);
}

}  // namespace cairn::networks
