// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/config/network_config.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "onboard/perception/networks/config/class_map.hpp"
#include "onboard/perception/networks/config/comma_list.hpp"

namespace cairn::networks {
namespace {

constexpr double kMaxSide = 4096;
constexpr std::size_t kMaxStrides = 8;
constexpr int kMaxStride = 256;

bool is_sum(const std::string& text) {
  return text.size() == 64 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
}

std::string faults_of(const NetworkConfig& c, const std::string& prefix) {
  std::string faults;
  const auto fault = [&](const char* key, const std::string& cause) { faults += "\n" + prefix + key + ": " + cause; };
  if (!c.sha256.empty() && !is_sum(c.sha256)) fault("sha256", "64 hexadecimal digits, as sha256sum prints them");
  if ((c.input_width == 0) != (c.input_height == 0))
    fault("input_width", "input_width and input_height are given together, or neither");
  if (std::any_of(c.std.begin(), c.std.end(), [](double s) { return std::abs(s) < 1e-6; }))
    fault("std", "the values are divided by it, so it cannot be 0");
  if (std::abs(c.divisor) < 1e-6) fault("divisor", "the values are divided by it, so it cannot be 0");
  if (c.family == "logits" && c.fit == "letterbox")
    fault("fit", "a network of the family logits labels the whole picture: write fit: stretch");
  if (const auto map = ClassMap::parse(c.classes); !map) fault("classes", map.error().detail);
  if (const auto strides = parse_strides(c.strides); !strides) fault("strides", strides.error().detail);
  return faults;
}

Result<void> result_of(const std::string& faults) {
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the profile", {}, {}, faults};
}

}  // namespace

PerceptionConfig::PerceptionConfig() {
  detection.family = thermal_detection.family = "yolox";
  detection.fit = thermal_detection.fit = "letterbox";
  detection.classes = thermal_detection.classes = "coco80";
}

void declare(config::Section& s, NetworkConfig& c) {
  s.text("model", c.model,
         "ONNX file; a relative path is looked for beside the profile, then in the installed share/cairn/config; "
         "empty: no such network");
  s.text("sha256", c.sha256, "of the file, as sha256sum prints it; empty: the file is not checked");
  s.choice("family", c.family, {"logits", "yolox", "ssd"},
           "form of the output: logits (a plane per class), yolox (rows of grids), ssd (a list of boxes)");
  s.integer("input_width", c.input_width, {0, kMaxSide}, "px", "of the network's input; 0: as the model says");
  s.integer("input_height", c.input_height, {0, kMaxSide}, "px", "of the network's input; 0: as the model says");
  s.choice("channels", c.channels, {"bgr", "rgb", "grey"}, "order of the input's planes");
  s.numbers(
      "mean", c.mean, {-1000, 1000}, "",
      "a value x of 0…255 enters as ((x - mean) / std) / divisor; one number per plane, in the order of channels");
  s.numbers("std", c.std, {-1000, 1000}, "", "see mean");
  s.number("divisor", c.divisor, {-1000, 1000}, "", "see mean");
  s.choice("fit", c.fit, {"stretch", "letterbox"},
           "how a picture of another shape fills the input; letterbox keeps its shape, in the upper left corner");
  s.number("letterbox_value", c.letterbox_value, {0, 255}, "", "what the picture does not fill of the input");
  s.text("classes", c.classes,
         "what the output's channels are: cityscapes19, cityscapes20, coco80, identity, or a list of a trainId, a "
         "class name or none for each channel");
  s.number("score_threshold", c.score_threshold, {0, 1}, "", "detections below it are dropped");
  s.number("nms_threshold", c.nms_threshold, {0, 1}, "",
           "of two boxes of a class that overlap more than this (intersection over union), the weaker is dropped");
  s.text("strides", c.strides, "yolox: of the grids, in pixels of the input, in the order of the output's rows");
  s.number("rate_hz", c.rate_hz, {0.1, 60}, "Hz", "pictures per second, at most");
}

void declare(config::Section& s, PerceptionConfig& c) {
  s.group("segmentation", c.segmentation, "the network that gives each pixel of a colour picture its class");
  s.group("detection", c.detection, "the network that finds people and vehicles in colour pictures");
  s.group("thermal_detection", c.thermal_detection,
          "the network that finds people in thermal pictures, which are stretched to 8 bits first");
}

Result<void> check(const NetworkConfig& config) {
  return config.exists() ? result_of(faults_of(config, "")) : Result<void>{};
}

Result<void> check(const PerceptionConfig& config) {
  std::string faults;
  if (config.segmentation.exists()) faults += faults_of(config.segmentation, "perception.segmentation.");
  if (config.detection.exists()) faults += faults_of(config.detection, "perception.detection.");
  if (config.thermal_detection.exists()) faults += faults_of(config.thermal_detection, "perception.thermal_detection.");
  if (config.segmentation.exists() && config.segmentation.family != "logits")
    faults += "\nperception.segmentation.family: a segmentation network is of the family logits";
  const std::pair<const char*, const NetworkConfig*> detectors[] = {{"detection", &config.detection},
                                                                    {"thermal_detection", &config.thermal_detection}};
  for (const auto& [key, network] : detectors)
    if (network->exists() && network->family == "logits")
      faults += std::string("\nperception.") + key + ".family: a detector is of the family yolox or ssd";
  return result_of(faults);
}

Result<std::vector<int>> parse_strides(const std::string& text) {
  const auto refuse = [&] {
    return Error{Errc::kInvalidConfig,
                 "not a list of strides",
                 {},
                 {},
                 "one to eight whole numbers from 1 to 256, such as 8, 16, 32"};
  };
  std::vector<int> strides;
  for (const std::string_view part : comma_list(text)) {
    const auto stride = whole_number(part);
    if (!stride || *stride < 1 || *stride > kMaxStride || strides.size() == kMaxStrides) return refuse();
    strides.push_back(*stride);
  }
  if (strides.empty()) return refuse();
  return strides;
}

}  // namespace cairn::networks
