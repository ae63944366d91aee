// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hal/image.hpp"
#include "hal/se3.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/perception/stereo/rectifier.hpp"

/// Simulated recordings of stereo pictures, for measuring tools.
namespace cairn::flights {

/// 0 of nothing.
inline double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Where the robot was.
struct Truth {
  std::map<std::int64_t, SE3> poses;  // by nanoseconds

  [[nodiscard]] SE3 at(std::int64_t ns) const {
    const auto after = poses.lower_bound(ns);
    if (after == poses.end()) return poses.rbegin()->second;
    if (after == poses.begin() || after->first == ns) return after->second;
    const auto before = std::prev(after);
    const double share = static_cast<double>(ns - before->first) / static_cast<double>(after->first - before->first);
    return before->second * SE3::exp(share * (before->second.inverse() * after->second).log());
  }
};

inline Truth load_truth(const std::filesystem::path& file) {
  Truth truth;
  std::ifstream in(file);
  double t = 0, x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 0;
  while (in >> t >> x >> y >> z >> qx >> qy >> qz >> qw)
    truth.poses[std::llround(t * 1e9)] = SE3(Eigen::Quaterniond(qw, qx, qy, qz), Eigen::Vector3d(x, y, z));
  return truth;
}

/// Stamps in nanoseconds and files, in order.
inline std::vector<std::pair<std::int64_t, std::filesystem::path>> pictures_of(const std::filesystem::path& recording) {
  std::vector<std::pair<std::int64_t, std::filesystem::path>> pictures;
  for (const auto& entry : std::filesystem::directory_iterator(recording / "camera" / "data"))
    if (entry.path().extension() == ".png") pictures.emplace_back(std::stoll(entry.path().stem()), entry.path());
  std::ranges::sort(pictures);
  return pictures;
}

/// `picture`: BGR.
inline Image image_of(const cv::Mat& picture, std::int64_t ns) {
  Image image;
  image.resize(PixelFormat::kBgr8, picture.cols, picture.rows);
  std::memcpy(image.bytes.data(), picture.data, image.bytes.size());
  image.stamp = Time{std::chrono::nanoseconds(ns)};
  return image;
}

/// What a recording's profile says of its stereo camera.
struct Eyes {
  stereo::Rectifier rectifier;
  SE3 T_base_eye;
  app::StereoProfile profile;
};

inline Result<Eyes> eyes_of(const std::filesystem::path& recording) {
  const auto chosen = app::choose_profile({}, recording);
  if (!chosen) return chosen.error();
  const app::CameraProfile& camera = chosen->profile.camera;
  const app::PictureSize size = picture_size(camera);
  const auto model = camera.intrinsics.model(size.width, size.height);
  if (!model) return model.error();
  auto rectifier = stereo::Rectifier::create(*model, camera.intrinsics.baseline_m,
                                             1e-6 * chosen->profile.perception.labelling.line_time_us);
  if (!rectifier) return rectifier.error();
  const SE3 T_base_camera = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(camera.base_xyz_rpy.data()));
  return Eyes{std::move(*rectifier), T_base_camera * cameras::T_camera_optical(), chosen->profile.stereo};
}

/// Arguments of a measuring tool: recordings, and KEY=VALUE, for which `set` says whether there is such a key.
template <class Set>
[[nodiscard]] bool read_arguments(std::span<char* const> arguments, std::vector<std::filesystem::path>& recordings,
                                  const Set& set) {
  for (const std::string text : arguments) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      recordings.emplace_back(text);
    } else if (!set(text.substr(0, equals), text.substr(equals + 1))) {
      std::fprintf(stderr, "%s: no such setting\n", text.c_str());
      return false;
    }
  }
  return true;
}

}  // namespace cairn::flights
