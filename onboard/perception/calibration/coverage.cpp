// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cairn::calibration {
namespace {

constexpr double kAlike = 0.03;            // distance of two shapes that count as the same view
constexpr std::size_t kLeastCorners = 20;  // in each ninth of the picture
constexpr std::size_t kLeastTilted = 3;    // views for each side of the board
constexpr std::size_t kLeastLarge = 3;     // views

using Shape = Eigen::Matrix<double, 7, 1>;

/// Place, size and tilt of a board in a picture. Each number changes by about 1 from one end of its range to the other.
Shape shape_of(const Board& board, const Corners& view, int width, int height) {
  const auto across = static_cast<std::size_t>(board.columns);
  Eigen::Vector2d a = view.front(), b = view[across - 1], c = view.back(), d = view[view.size() - across];
  if ((c - a).sum() < 0) {
    std::swap(a, c);
    std::swap(b, d);
  }
  const Eigen::Vector2d middle = 0.25 * (a + b + c + d), e = (b - a) / (b - a).norm();
  const Eigen::Vector2d p = c - a, q = d - b;
  const double area = 0.5 * std::abs(p.x() * q.y() - p.y() * q.x());
  Shape shape;
  shape << middle.x() / width, middle.y() / height, 1.5 * std::sqrt(area) / width,
      2 * std::log((b - a).norm() / (c - d).norm()), 2 * std::log((d - a).norm() / (c - b).norm()), 0.3 * e.x(),
      0.3 * e.y();
  return shape;
}

double widest(const Corners& view) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Eigen::Vector2d& p : view) {
    low = std::min(low, p.x());
    high = std::max(high, p.x());
  }
  return high - low;
}

std::size_t ninth(const Eigen::Vector2d& p, int width, int height) {
  const auto third = [](double share) { return static_cast<std::size_t>(std::clamp(3 * share, 0.0, 2.0)); };
  return 3 * third((p.y() + 0.5) / height) + third((p.x() + 0.5) / width);
}

}  // namespace

std::vector<std::size_t> select_views(const Board& board, std::span<const Corners> views, int width, int height,
                                      std::size_t most) {
  std::vector<Shape> shapes;
  for (const Corners& view : views) shapes.push_back(shape_of(board, view, width, height));
  std::vector<double> distance(views.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> chosen;
  while (chosen.size() < std::min(most, views.size())) {
    const auto far = std::max_element(distance.begin(), distance.end());
    if (*far < kAlike) break;
    const auto next = static_cast<std::size_t>(far - distance.begin());
    chosen.push_back(next);
    for (std::size_t i = 0; i < shapes.size(); ++i)
      distance[i] = std::min(distance[i], (shapes[i] - shapes[next]).norm());
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

Coverage coverage(std::span<const Corners> views, std::span<const SE3> T_optical_board, int width, int height) {
  Coverage c;
  for (const Corners& view : views) {
    for (const Eigen::Vector2d& p : view) ++c.corners[ninth(p, width, height)];
    if (widest(view) >= Coverage::kLarge * width) ++c.large;
  }
  const double tilted = std::sin(Coverage::kTilt_deg * std::numbers::pi / 180);
  for (const SE3& T : T_optical_board) {
    const Eigen::Vector3d away = T.rotation().col(2);  // from the camera: the side that it leans to is near
    if (away.x() >= tilted) ++c.right_near;
    if (away.x() <= -tilted) ++c.left_near;
    if (away.y() >= tilted) ++c.bottom_near;
    if (away.y() <= -tilted) ++c.top_near;
    if (away.head<2>().norm() < tilted) ++c.frontal;
  }
  return c;
}

std::vector<std::string> Coverage::missing() const {
  static constexpr std::array kNinths{"upper left",   "upper middle", "upper right",  "middle left", "middle",
                                      "middle right", "lower left",   "lower middle", "lower right"};
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (corners[i] < kLeastCorners) lines.push_back(std::string("the board in the ") + kNinths[i] + " of the picture");
  const auto side = [&](std::size_t count, const char* name) {
    if (count < kLeastTilted)
      lines.push_back(std::string("the board tilted by 30 to 45 degrees with its ") + name + " towards the camera");
  };
  side(left_near, "left side");
  side(right_near, "right side");
  side(top_near, "top");
  side(bottom_near, "bottom");
  if (large < kLeastLarge) lines.emplace_back("the board so near that it spans half of the picture");
  return lines;
}

}  // namespace cairn::calibration
