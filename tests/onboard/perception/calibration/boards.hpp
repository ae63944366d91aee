// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "hal/image.hpp"
#include "onboard/perception/calibration/board.hpp"
#include "onboard/perception/cameras/camera_model.hpp"

namespace cairn::calibration::test {

inline constexpr Board kBoard{.columns = 9, .rows = 6, .square_m = 0.03};

inline cameras::CameraParameters small_camera() {
  return {.width = 336,
          .height = 240,
          .fx = 190,
          .fy = 191,
          .cx = 168.2,
          .cy = 118.7,
          .distortion = {.model = cameras::DistortionModel::kRadTan, .k = {-0.17, 0.026, 0.0004, -0.0003}}};
}

inline cameras::CameraParameters fisheye_camera() {
  return {.width = 400,
          .height = 400,
          .fx = 140,
          .fy = 140.5,
          .cx = 201,
          .cy = 198,
          .distortion = {.model = cameras::DistortionModel::kEquidistant, .k = {0.02, -0.004, 0.001, -0.0002}}};
}

/// T_optical_board of a board whose middle is at `middle`, turned about x, y and z of the optical frame (radians).
inline SE3 board_at(const Board& board, const Eigen::Vector3d& middle, const Eigen::Vector3d& turn) {
  const Eigen::Quaterniond R = Eigen::AngleAxisd(turn.x(), Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(turn.y(), Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(turn.z(), Eigen::Vector3d::UnitZ());
  return SE3(R, middle) * SE3(Eigen::Quaterniond::Identity(), -board.centre());
}

/// Where the camera sees the corners, with Gaussian noise. None: a corner is outside of the picture.
inline std::optional<Corners> seen_corners(const cameras::CameraModel& camera, const Board& board, const SE3& T,
                                           double noise_px, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 1);
  Corners corners;
  for (std::size_t i = 0; i < board.corners(); ++i) {
    const auto pixel = camera.project(T * board.corner(i));
    if (!pixel) return {};
    const double du = noise(random), dv = noise(random);
    corners.emplace_back(*pixel + noise_px * Eigen::Vector2d(du, dv));
  }
  return corners;
}

/// How boards are held before a camera.
struct Holding {
  double nearest = 4, farthest = 12;                        ///< squares of the board in front of the camera
  double tilt = 0.7;                                        ///< radians, at most, about x and about y
  double least_u = 0, most_u = 1, least_v = 0, most_v = 1;  ///< where the middle is, as a share of the picture
};

inline SE3 random_pose(const cameras::CameraModel& camera, const Board& board, const Holding& how,
                       std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto between = [&](double low, double high) { return low + (high - low) * unit(random); };
  for (;;) {
    const Eigen::Vector2d pixel(between(how.least_u, how.most_u) * camera.width(),
                                between(how.least_v, how.most_v) * camera.height());
    const auto ray = camera.unproject(pixel);
    const double distance = board.square_m * between(how.nearest, how.farthest);
    const Eigen::Vector3d turn(between(-how.tilt, how.tilt), between(-how.tilt, how.tilt), between(-0.3, 0.3));
    if (ray && ray->z() > 0.2) return board_at(board, *ray * (distance / ray->z()), turn);
  }
}

/// `count` views that are whole in the picture.
inline std::vector<Corners> random_views(const cameras::CameraModel& camera, const Board& board, std::size_t count,
                                         double noise_px, const Holding& how, std::mt19937& random) {
  std::vector<Corners> views;
  while (views.size() < count)
    if (auto corners = seen_corners(camera, board, random_pose(camera, board, how, random), noise_px, random))
      views.push_back(*std::move(corners));
  return views;
}

/// Draws boards as a camera sees them. Rays are computed once.
class BoardPainter {
 public:
  BoardPainter(const cameras::CameraModel& camera, int per_pixel) : camera_(camera), per_pixel_(per_pixel) {
    rays_.reserve(static_cast<std::size_t>(camera.width() * camera.height() * per_pixel * per_pixel));
    for (int v = 0; v < camera.height() * per_pixel; ++v)
      for (int u = 0; u < camera.width() * per_pixel; ++u) {
        const auto ray = camera.unproject({(u + 0.5) / per_pixel - 0.5, (v + 0.5) / per_pixel - 0.5});
        rays_.push_back(ray ? Eigen::Vector3f(ray->cast<float>()) : Eigen::Vector3f(0, 0, -1));
      }
  }

  /// Grey values have Gaussian noise. `dark` and `bright`: of the squares. The rim is 0.7 squares wide.
  Image paint(const Board& board, const SE3& T_optical_board, double noise, std::mt19937& random, double dark = 40,
              double bright = 210) const {
    std::normal_distribution<double> error(0, noise);
    Image image;
    image.resize(PixelFormat::kMono8, camera_.width(), camera_.height());
    const SE3 T = T_optical_board.inverse();
    const Eigen::Matrix3f R = T.rotation().cast<float>();
    const Eigen::Vector3f eye = T.translation().cast<float>();
    for (int v = 0; v < camera_.height(); ++v)
      for (int u = 0; u < camera_.width(); ++u) {
        double sum = 0;
        for (int k = 0; k < per_pixel_ * per_pixel_; ++k) {
          const int row = v * per_pixel_ + k / per_pixel_, column = u * per_pixel_ + k % per_pixel_;
          const auto at = static_cast<std::size_t>(row * camera_.width() * per_pixel_ + column);
          sum += grey(board, eye, R * rays_[at], dark, bright);
        }
        const double value = sum / (per_pixel_ * per_pixel_) + error(random);
        image.bytes[static_cast<std::size_t>(v * camera_.width() + u)] =
            static_cast<std::byte>(std::clamp(value, 0.0, 255.0));
      }
    return image;
  }

 private:
  static double grey(const Board& board, const Eigen::Vector3f& eye, const Eigen::Vector3f& ray, double dark,
                     double bright) {
    const double background = 0.5 * (dark + bright);
    const float s = -eye.z() / ray.z();
    if (!(s > 0)) return background;
    const double x = (eye.x() + s * ray.x()) / board.square_m, y = (eye.y() + s * ray.y()) / board.square_m;
    if (x < -1.7 || y < -1.7 || x > board.columns + 0.7 || y > board.rows + 0.7) return background;
    if (x < -1 || y < -1 || x > board.columns || y > board.rows) return bright;
    const bool even = (static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(y))) % 2 == 0;
    return even ? dark : bright;
  }

  cameras::CameraModel camera_;
  int per_pixel_;
  std::vector<Eigen::Vector3f> rays_;
};

}  // namespace cairn::calibration::test
