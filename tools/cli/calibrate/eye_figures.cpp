// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/eye_figures.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "hal/files/file.hpp"
#include "onboard/perception/cameras/calibration_writer.hpp"

namespace cairn::cli {
namespace {

double value_of(const cameras::CameraParameters& p, std::size_t unknown) {
  const std::array first{p.fx, p.fy, p.cx, p.cy};
  return unknown < first.size() ? first[unknown] : p.distortion.k[unknown - first.size()];
}

}  // namespace

report::Json number(double value) { return std::isfinite(value) ? report::Json(value) : report::Json(nullptr); }

report::Json eye_json(const calibration::EyeEstimate& eye) {
  const cameras::CameraParameters& p = eye.parameters;
  report::Json json{
      {"width", p.width},
      {"height", p.height},
      {"distortion", p.distortion.model == cameras::DistortionModel::kEquidistant ? "equidistant" : "radtan"},
      {"rms_px", number(eye.rms_px)},
      {"corner_deviation_px", number(eye.corner_deviation_px)}};
  const auto names = calibration::unknown_names(p.distortion.model);
  for (std::size_t i = 0; i < names.size(); ++i)
    json["parameters"][std::string(names[i])] = {{"value", number(value_of(p, i))},
                                                 {"deviation", number(eye.deviation(static_cast<Eigen::Index>(i)))}};
  return json;
}

std::string eye_text(const calibration::EyeEstimate& eye) {
  const auto names = calibration::unknown_names(eye.parameters.distortion.model);
  std::string text = fmt::format("residuals: {:.3f} px (one axis, root mean square)\n", eye.rms_px);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double deviation = eye.deviation(static_cast<Eigen::Index>(i));
    const int digits = i < 4 ? 2 : 5;
    text +=
        fmt::format("{:<3} {:>11.{}f} ± {:.{}f}\n", names[i], value_of(eye.parameters, i), digits, deviation, digits);
  }
  return text + fmt::format("a pixel in the corners of the picture is known to {:.2f} px\n", eye.corner_deviation_px);
}

report::Json coverage_json(const calibration::Coverage& c) {
  report::Json json{{"corners", c.corners},     {"frontal", c.frontal},
                    {"left_near", c.left_near}, {"right_near", c.right_near},
                    {"top_near", c.top_near},   {"bottom_near", c.bottom_near},
                    {"large", c.large}};
  json["missing"] = c.missing();
  return json;
}

void print_verdict(const std::vector<std::string>& faults, const std::vector<std::string>& missing) {
  for (const std::string& fault : faults) std::cout << "refused: " << fault << '\n';
  for (const std::string& view : missing)
    std::cout << (faults.empty() ? "would make it better: " : "record: ") << view << '\n';
}

Result<void> write_calibration(const std::filesystem::path& out, const std::string& format,
                               const cameras::Calibration& calibration) {
  const auto text = format == "ros"      ? cameras::to_ros(calibration.cameras[0], "camera")
                    : format == "opencv" ? cameras::to_opencv(calibration.cameras[0])
                                         : cameras::to_kalibr(calibration);
  if (!text) return at(out.string(), text.error());
  return write_file_atomic(out, *text);
}

}  // namespace cairn::cli
