// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hal/config/config.hpp"
#include "hal/result.hpp"

namespace cairn::networks {

/// One neural network and how it is to be fed and read. docs/perception.md describes what a network must look like.
struct NetworkConfig {
  std::string model;              ///< ONNX file, see find_model(); empty: there is no such network
  std::string sha256;             ///< of the file, 64 hexadecimal digits; empty: it is not checked
  std::string family = "logits";  ///< form of the output: logits, yolox or ssd
  int input_width = 0;            ///< pixels; 0: as the model says
  int input_height = 0;           ///< pixels; 0: as the model says
  std::string channels = "bgr";   ///< order of the input's planes: bgr, rgb or grey
  /// A channel's value x, 0…255, enters as ((x − mean) / std) / divisor. One number per plane, in the order of
  /// `channels`; grey takes the first.
  std::vector<double> mean{0, 0, 0};
  std::vector<double> std{1, 1, 1};
  double divisor = 1;
  std::string fit = "stretch";           ///< stretch, or letterbox: the picture keeps its shape, upper left
  double letterbox_value = 114;          ///< of what the picture does not fill, 0…255
  std::string classes = "cityscapes19";  ///< of the output's channels, see ClassMap::parse()
  double score_threshold = 0.3;          ///< detections below it are dropped
  double nms_threshold = 0.45;           ///< the weaker of two boxes of a class that overlap more than this is dropped
  std::string strides = "8, 16, 32";     ///< yolox: of the grids, in pixels of the input, in the output's order
  double rate_hz = 5;                    ///< pictures per second, at most

  [[nodiscard]] bool exists() const { return !model.empty(); }
};

/// Section `perception` of a robot profile.
struct PerceptionConfig {
  PerceptionConfig();

  NetworkConfig segmentation;       ///< classes of a colour picture's pixels
  NetworkConfig detection;          ///< boxes in colour pictures
  NetworkConfig thermal_detection;  ///< boxes in thermal pictures, stretched to 8 bits
};

// Doxygen takes these overloads for one function, so they are left out of the API reference.
/// \cond OVERLOADS
void declare(config::Section& section, NetworkConfig& config);
void declare(config::Section& section, PerceptionConfig& config);

/// Checks what bounds cannot; a network that does not exist is sound. Error kInvalidConfig with all faults, a line
/// each.
[[nodiscard]] Result<void> check(const NetworkConfig& config);
[[nodiscard]] Result<void> check(const PerceptionConfig& config);
/// \endcond

/// The strides as numbers. Error kInvalidConfig: not one to eight whole numbers from 1 to 256.
[[nodiscard]] Result<std::vector<int>> parse_strides(const std::string& text);

}  // namespace cairn::networks
