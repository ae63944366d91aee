// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/import/kitti_camera.hpp"

#include <Eigen/LU>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "drivers/recording/formats/text_lines.hpp"
#include "drivers/recording/import/kitti_files.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;

constexpr double kRotationResidual = 0.01;
constexpr std::size_t kMostNumbers = 12;

struct Numbers {
  std::array<double, kMostNumbers> values{};
  bool found = false;
};

/// The numbers of the line `key: …`; not found where there is no such line.
Result<Numbers> numbers_of(std::string_view text, std::string_view name, const std::string& key, std::size_t count) {
  LineReader lines(text, name);
  while (const auto line = lines.next()) {
    if (!line->starts_with(key + ":")) continue;
    std::string_view parts[kMostNumbers];
    if (split(line->substr(key.size() + 1), ' ', parts) != count)
      return lines.fault(Errc::kMalformed, "another count of numbers expected", key + ": " + std::to_string(count));
    Numbers numbers{.values = {}, .found = true};
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = parse_number(parts[i]);
      if (!value || std::abs(*value) > 1e6) return lines.fault(Errc::kMalformed, "not a usable number", key);
      numbers.values[i] = *value;
    }
    return numbers;
  }
  return Numbers{};
}

Result<Numbers> required(std::string_view text, std::string_view name, const std::string& key, std::size_t count) {
  auto numbers = numbers_of(text, name, key, count);
  if (numbers && !numbers->found)
    return Error{Errc::kNotFound, "the calibration lacks a line", std::string(name), {}, "`" + key + ":`"};
  return numbers;
}

Result<SE3> rigid(const Eigen::Matrix3d& R, const Eigen::Vector3d& t, std::string_view name, const char* key) {
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() <= kRotationResidual) || R.determinant() < 0)
    return Error{Errc::kMalformed, "the 3x3 part is not a rotation", std::string(name), {}, key};
  return SE3(R, t);
}

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

Result<SE3> parse_T_cam0_velodyne(std::string_view text, std::string_view name) {
  const auto together = numbers_of(text, name, "T_velo_to_cam0", 12);
  if (!together) return together.error();
  if (together->found) {
    const Eigen::Map<const RowMajor34> T(together->values.data());
    return rigid(T.leftCols<3>(), T.col(3), name, "T_velo_to_cam0");
  }
  const auto R = required(text, name, "R", 9), t = required(text, name, "T", 3);
  if (!R) return R.error();
  if (!t) return t.error();
  return rigid(Eigen::Map<const RowMajor3>(R->values.data()), Eigen::Map<const Eigen::Vector3d>(t->values.data()), name,
               "R");
}

std::string shortest(double v) {
  char buffer[32];
  return {std::begin(buffer), std::to_chars(std::begin(buffer), std::end(buffer), v).ptr};
}

/// The texts of the files that are there, one after the other.
Result<std::string> texts_in(const fs::path& folder, std::initializer_list<const char*> names) {
  std::string all;
  for (const char* name : names) {
    std::error_code ignored;
    if (!fs::exists(folder / name, ignored)) continue;
    const auto text = read_text(folder / name);
    if (!text) return text.error();
    all += *text + "\n";
  }
  return all;
}

}  // namespace

Result<std::optional<KittiCamera>> parse_kitti_camera(std::string_view text, std::string_view name) {
  const auto P = numbers_of(text, name, "P_rect_02", 12);
  if (!P) return P.error();
  if (!P->found) return std::optional<KittiCamera>{};
  const auto rectified = required(text, name, "R_rect_00", 9);
  if (!rectified) return rectified.error();
  const auto R_rect =
      rigid(Eigen::Map<const RowMajor3>(rectified->values.data()), Eigen::Vector3d::Zero(), name, "R_rect_00");
  if (!R_rect) return R_rect.error();
  const auto T_cam0_velodyne = parse_T_cam0_velodyne(text, name);
  if (!T_cam0_velodyne) return T_cam0_velodyne.error();
  const Eigen::Map<const RowMajor34> projection(P->values.data());
  if (!(projection(0, 0) > 0 && projection(1, 1) > 0))
    return Error{Errc::kMalformed, "no focal length", std::string(name), {}, "P_rect_02"};
  // P = K [I | t]: where the rectified camera 0 lies in camera 2.
  const Eigen::Vector3d t = projection.leftCols<3>().inverse() * projection.col(3);
  const SE3 T_optical_rect0(Eigen::Quaterniond::Identity(), t);
  return std::optional(KittiCamera{.fx = projection(0, 0),
                                   .fy = projection(1, 1),
                                   .cx = projection(0, 2),
                                   .cy = projection(1, 2),
                                   .T_optical_velodyne = T_optical_rect0 * *R_rect * *T_cam0_velodyne});
}

Result<std::optional<KittiCamera>> find_kitti_camera(const fs::path& drive) {
  std::error_code ignored;
  const fs::path day = fs::weakly_canonical(drive, ignored).parent_path();
  for (const fs::path& folder : {drive, day}) {
    const auto text = texts_in(folder, {"calib.txt", "calib_cam_to_cam.txt", "calib_velo_to_cam.txt"});
    if (!text) return text.error();
    auto camera = parse_kitti_camera(*text, (folder / "calib*.txt").string());
    if (!camera || *camera) return camera;
  }
  return std::optional<KittiCamera>{};
}

std::string kitti_profile(const std::string& robot, const KittiCamera& c, std::uint32_t width, std::uint32_t height,
                          double rate_hz) {
  Eigen::Matrix3d R_optical_camera;  // of the REP-103 body: x along the view, y left, z up
  R_optical_camera << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const SE3 T_velodyne_camera = c.T_optical_velodyne.inverse() * SE3(R_optical_camera, Eigen::Vector3d::Zero());
  std::string mount;
  for (const double v : T_velodyne_camera.xyz_rpy()) mount += (mount.empty() ? "" : ", ") + shortest(v);
  const std::string size = "width: " + std::to_string(width) + ", height: " + std::to_string(height);
  return "# From the calibration of a KITTI raw drive. Keys left out keep their defaults.\nname: " + robot +
         "\nlidar:\n  T_base_lidar: [0, 0, 0, 0, 0, 0]  # base_link is the LiDAR's frame\ncamera:\n  capture: {format: "
         "BGR3, " +
         size + ", rate_hz: " + shortest(rate_hz) + "}\n  side_by_side: false\n  T_base_camera: [" + mount +
         "]\n  intrinsics: {" + size + ", fx: " + shortest(c.fx) + ", fy: " + shortest(c.fy) +
         ", cx: " + shortest(c.cx) + ", cy: " + shortest(c.cy) + "}  # P_rect_02: the pictures are rectified\n";
}

}  // namespace cairn::recording
