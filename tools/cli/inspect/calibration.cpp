// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <variant>

#include "hal/files/file.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/perception/cameras/calibration_writer.hpp"

namespace cairn::cli {
namespace {

using cameras::CalibratedCamera;
using cameras::Calibration;
using cameras::CameraModel;

/// Degrees between the rays of two pixels; null where the lens has none there.
report::Json angle_between(const CameraModel& model, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const auto from = model.unproject(a), to = model.unproject(b);
  if (!from || !to) return nullptr;
  return std::atan2(from->cross(*to).norm(), from->dot(*to)) * 180 / std::numbers::pi;
}

report::Json describe(const CalibratedCamera& camera) {
  const cameras::CameraParameters& p = camera.parameters;
  const bool equidistant = p.distortion.model == cameras::DistortionModel::kEquidistant;
  report::Json json{{"width", p.width},
                    {"height", p.height},
                    {"fx", p.fx},
                    {"fy", p.fy},
                    {"cx", p.cx},
                    {"cy", p.cy},
                    {"distortion", equidistant ? "equidistant" : "radtan"},
                    {"coefficients", p.distortion.k},
                    {"baseline_m", camera.baseline_m ? report::Json(*camera.baseline_m) : report::Json(nullptr)}};
  json["usable_angle_deg"] = 2 * std::atan(p.distortion.largest_radius()) * 180 / std::numbers::pi;
  const auto model = CameraModel::create(p);
  if (!model) return json;  // the file does not say the size
  json["view_across_deg"] = angle_between(*model, {-0.5, p.cy}, {p.width - 0.5, p.cy});
  json["view_down_deg"] = angle_between(*model, {p.cx, -0.5}, {p.cx, p.height - 0.5});
  return json;
}

Result<std::string> written_as(const std::string& format, const Calibration& calibration, std::size_t camera) {
  if (format == "kalibr") return to_kalibr(calibration);
  if (camera >= calibration.cameras.size())
    return Error{Errc::kNotFound,
                 "there is no such camera",
                 "--camera",
                 {},
                 "the file has " + std::to_string(calibration.cameras.size())};
  if (format == "ros") return to_ros(calibration.cameras[camera], "camera");
  if (format == "opencv") return to_opencv(calibration.cameras[camera]);
  return Error{Errc::kInvalidConfig, "the format is missing", "--as", {}, "kalibr, ros or opencv"};
}

/// Whether a line of the file begins with the name of one of a profile's sections.
bool is_profile(const std::filesystem::path& path) {
  constexpr std::uint64_t kMostBytes = 1U << 20U;
  const auto bytes = read_file(path, kMostBytes);
  if (!bytes) return false;
  const std::string text = "\n" + std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  config::Section section;
  app::RobotProfile profile;
  declare(section, profile);
  return std::ranges::any_of(section.fields(), [&](const config::Field& field) {
    const bool group = std::holds_alternative<std::unique_ptr<config::Section>>(field.target);
    return group && text.find("\n" + field.key + ":") != std::string::npos;
  });
}

}  // namespace

Result<report::Json> inspect_calibration(const std::filesystem::path& path, const std::filesystem::path& out,
                                         const std::string& format, std::size_t camera) {
  const auto calibration = cameras::load_calibration(path);
  if (!calibration && is_profile(path))
    return Error{Errc::kUnsupported,
                 "this is the profile of a robot, not data",
                 path.string(),
                 {},
                 "cairn doctor --config " + path.string() + " checks it"};
  if (!calibration) return calibration.error();
  report::Json json{{"kind", "calibration"},
                    {"path", path.string()},
                    {"format", std::string(to_string(calibration->format))},
                    {"cameras", report::Json::array()}};
  for (const CalibratedCamera& c : calibration->cameras) json["cameras"].push_back(describe(c));
  if (out.empty()) return json;
  const auto text = written_as(format, *calibration, camera);
  if (!text) return at(path.string(), text.error());
  if (auto written = write_file_atomic(out, *text); !written) return written.error();
  json["out"] = {{"file", out.string()}, {"format", format}};
  return json;
}

}  // namespace cairn::cli
