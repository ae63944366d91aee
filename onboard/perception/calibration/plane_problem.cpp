// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/plane_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "onboard/perception/calibration/eyes_problem.hpp"

namespace cairn::calibration {
namespace {

constexpr double kHuber = 2.5;                   // deviations
constexpr double kLeastPoint_m = 1e-4;           // noise of points, at least
constexpr double kLeastCorner_px = 1e-3;         // noise of corners, at least
constexpr double kMedianToDeviation = 1.482602;  // of the absolute values of a normal distribution

}  // namespace

double PlaneProblem::corner_squares(std::size_t pose) const {
  double squares = 0;
  for (std::size_t i = 0; i < board_.corners(); ++i) {
    const auto seen = see(eye_, now_.T_optical_board[pose] * board_.corner(i));
    if (!seen) return std::numeric_limits<double>::infinity();
    squares += (seen->pixel - poses_[pose].corners[i]).squaredNorm();
  }
  return squares;
}

double PlaneProblem::distance(std::size_t pose, const Eigen::Vector3d& point) const {
  return (now_.T_optical_board[pose].inverse() * (now_.T_optical_points * point)).z();
}

double PlaneProblem::cost() const {
  double sum = 0;
  for (std::size_t pose = 0; pose < poses_.size(); ++pose) {
    sum += corner_squares(pose) / (noise_.corner_px * noise_.corner_px);
    for (const Eigen::Vector3d& point : poses_[pose].points) {
      const double r = std::abs(distance(pose, point)) / noise_.point_m;
      sum += r < kHuber ? r * r : kHuber * (2 * r - kHuber);
    }
  }
  return sum;
}

void PlaneProblem::add_corners(std::size_t pose, NormalEquations& equations) const {
  const SE3& T = now_.T_optical_board[pose];
  const Eigen::Matrix3d R = T.rotation();
  const double weight = 1 / (noise_.corner_px * noise_.corner_px);
  const Eigen::RowVectorXd none = Eigen::RowVectorXd::Zero(6);
  for (std::size_t i = 0; i < board_.corners(); ++i) {
    const Eigen::Vector3d corner = board_.corner(i);
    const auto seen = see(eye_, T * corner);
    if (!seen) continue;  // cost() has refused it
    Eigen::Matrix<double, 3, 6> by_pose;
    by_pose << R, -R * hat(corner);
    const Eigen::Matrix<double, 2, 6> by = seen->by_point * by_pose;
    const Eigen::Vector2d residual = seen->pixel - poses_[pose].corners[i];
    for (Eigen::Index k = 0; k < 2; ++k) equations.add(pose, none, by.row(k), residual[k], weight);
  }
}

void PlaneProblem::add_points(std::size_t pose, NormalEquations& equations) const {
  const SE3 T_board_optical = now_.T_optical_board[pose].inverse(),
            T_board_points = T_board_optical * now_.T_optical_points;
  const Eigen::RowVector3d normal = T_board_points.rotation().row(2);
  for (const Eigen::Vector3d& point : poses_[pose].points) {
    const Eigen::Vector3d on_board = T_board_points * point;
    Eigen::RowVectorXd by_mount(6);
    by_mount << normal, -normal * hat(point);
    Eigen::Matrix<double, 1, 6> by_pose;
    by_pose << 0, 0, -1, hat(on_board).row(2);
    const double r = std::abs(on_board.z()) / noise_.point_m, weight = r < kHuber ? 1 : kHuber / r;
    equations.add(pose, by_mount, by_pose, on_board.z(), weight / (noise_.point_m * noise_.point_m));
  }
}

NormalEquations PlaneProblem::linearise() const {
  NormalEquations equations(6, poses_.size());
  for (std::size_t pose = 0; pose < poses_.size(); ++pose) {
    add_corners(pose, equations);
    add_points(pose, equations);
  }
  return equations;
}

PlaneProblem PlaneProblem::moved(const Step& step) const {
  PlaneProblem next = *this;
  next.now_.T_optical_points = now_.T_optical_points * SE3::exp(Vector6(step.shared));
  for (std::size_t pose = 0; pose < poses_.size(); ++pose)
    next.now_.T_optical_board[pose] = now_.T_optical_board[pose] * SE3::exp(step.poses[pose]);
  return next;
}

PlaneProblem PlaneProblem::with_noise_of_residuals() const {
  double squares = 0, count = 0;
  std::vector<double> distances;
  for (std::size_t pose = 0; pose < poses_.size(); ++pose) {
    squares += corner_squares(pose);
    count += 2 * static_cast<double>(board_.corners()) - 6;
    for (const Eigen::Vector3d& point : poses_[pose].points) distances.push_back(std::abs(distance(pose, point)));
  }
  PlaneProblem next = *this;
  next.noise_.corner_px = std::max(kLeastCorner_px, std::sqrt(squares / count));
  if (distances.empty()) return next;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  next.noise_.point_m = std::max(kLeastPoint_m, kMedianToDeviation * *middle);
  return next;
}

}  // namespace cairn::calibration
