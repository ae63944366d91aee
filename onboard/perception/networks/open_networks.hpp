// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "hal/ports.hpp"
#include "hal/result.hpp"
#include "onboard/perception/networks/config/network_config.hpp"
#include "onboard/perception/networks/model/model_file.hpp"
#include "onboard/perception/networks/model/network.hpp"

namespace cairn::networks {

/// Opens the network of the family `logits`. Its file is checked, it is run once, and its output's shape must fit the
/// classes. `folders`: where a relative path is looked for, see model_folders(); none: in the current folder. `facts`
/// is filled where given. The label image has the size of the network's output. Takes as long as a few pictures.
/// Errors: those of Network::load(), and kInvalidConfig for an output of another form. Each says what was expected and
/// found.
[[nodiscard]] Result<std::unique_ptr<Segmenter>> open_segmenter(const NetworkConfig& config,
                                                                std::span<const std::filesystem::path> folders = {},
                                                                NetworkFacts* facts = nullptr);

/// The same for a network of the family `yolox` or `ssd`. Boxes are in pixels of the picture, best first.
[[nodiscard]] Result<std::unique_ptr<Detector>> open_detector(const NetworkConfig& config,
                                                              std::span<const std::filesystem::path> folders = {},
                                                              NetworkFacts* facts = nullptr);

}  // namespace cairn::networks
