// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/eyes_problem.hpp"

#include <limits>
#include <opencv2/calib3d.hpp>

namespace cairn::calibration {
namespace {

using cameras::CameraParameters;
using cameras::Distortion;

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kNearest_m = 1e-3;  // of a point in front of an eye

void change(CameraParameters& eye, const Eigen::Ref<const Eigen::VectorXd>& by) {
  eye.fx += by[0];
  eye.fy += by[1];
  eye.cx += by[2];
  eye.cy += by[3];
  for (Eigen::Index i = 0; i < 4; ++i) eye.distortion.k[static_cast<std::size_t>(i)] += by[4 + i];
}

/// Both models are linear in these coefficients, so the difference of two values is the derivative.
Eigen::Matrix<double, 2, 4> by_coefficients(const Distortion& distortion, const Eigen::Vector2d& ideal) {
  const Distortion none{.model = distortion.model};
  const Eigen::Vector2d base = none.distort(ideal);
  Eigen::Matrix<double, 2, 4> by;
  for (std::size_t i = 0; i < 4; ++i) {
    Distortion one = none;
    one.k[i] = 1;
    by.col(static_cast<Eigen::Index>(i)) = one.distort(ideal) - base;
  }
  return by;
}

}  // namespace

std::optional<SeenPoint> see(const CameraParameters& eye, const Eigen::Vector3d& point) {
  if (!(point.z() > kNearest_m)) return {};
  const Eigen::Vector2d ideal = point.head<2>() / point.z();
  const Eigen::Vector2d d = eye.distortion.distort(ideal);
  const Eigen::Vector2d focal(eye.fx, eye.fy);
  SeenPoint seen{.pixel = focal.cwiseProduct(d) + Eigen::Vector2d(eye.cx, eye.cy), .by_eye = {}, .by_point = {}};
  seen.by_eye.setZero();
  seen.by_eye(0, 0) = d.x();
  seen.by_eye(1, 1) = d.y();
  seen.by_eye(0, 2) = seen.by_eye(1, 3) = 1;
  seen.by_eye.rightCols<4>() = focal.asDiagonal() * by_coefficients(eye.distortion, ideal);
  Eigen::Matrix<double, 2, 3> by_point;
  by_point << 1, 0, -ideal.x(), 0, 1, -ideal.y();
  seen.by_point = focal.asDiagonal() * eye.distortion.jacobian(ideal) * by_point / point.z();
  return seen;
}

std::optional<SE3> board_pose(const CameraParameters& eye, const Board& board, const Corners& corners) {
  const auto model = cameras::CameraModel::create(eye);
  if (!model || corners.size() != board.corners()) return {};
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> rays;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto ray = model->unproject(corners[i]);
    if (!ray || !(ray->z() > 1e-3)) return {};
    const Eigen::Vector3d p = board.corner(i) - board.centre();
    points.emplace_back(p.x(), p.y(), p.z());
    rays.emplace_back(ray->x() / ray->z(), ray->y() / ray->z());
  }
  cv::Mat turn, shift;
  try {
    if (!cv::solvePnP(points, rays, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), turn, shift, false, cv::SOLVEPNP_IPPE))
      return {};
    cv::solvePnPRefineLM(points, rays, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), turn, shift);
  } catch (const cv::Exception&) {
    return {};
  }
  const Eigen::Vector3d w(turn.at<double>(0), turn.at<double>(1), turn.at<double>(2));
  const Eigen::Vector3d t(shift.at<double>(0), shift.at<double>(1), shift.at<double>(2));
  if (!w.allFinite() || !t.allFinite() || !(t.z() > kNearest_m)) return {};
  const double angle = w.norm();
  const Eigen::AngleAxisd R(angle, angle > 0 ? Eigen::Vector3d(w / angle) : Eigen::Vector3d::UnitX());
  return SE3(Eigen::Quaterniond(R), t) * SE3(Eigen::Quaterniond::Identity(), -board.centre());
}

Eigen::Index EyesProblem::unknowns() const {
  const auto eyes = static_cast<Eigen::Index>(now_.eyes.size());
  return (now_.eyes_known ? 0 : kEyeUnknowns * eyes) + (eyes > 1 ? 6 : 0);
}

double EyesProblem::degrees_of_freedom() const {
  const double residuals = 2.0 * static_cast<double>(views_.size() * now_.eyes.size() * board_.corners());
  return residuals - static_cast<double>(unknowns()) - 6.0 * static_cast<double>(views_.size());
}

double EyesProblem::cost_of(std::size_t view, std::size_t eye) const {
  const SE3 T = eye == 0 ? now_.T_left_board[view] : now_.T_right_left * now_.T_left_board[view];
  double sum = 0;
  for (std::size_t i = 0; i < board_.corners(); ++i) {
    const Eigen::Vector3d point = T * board_.corner(i);
    if (!(point.z() > kNearest_m)) return kNone;
    const CameraParameters& e = now_.eyes[eye];
    const Eigen::Vector2d d = e.distortion.distort(point.head<2>() / point.z());
    sum += (Eigen::Vector2d(e.fx * d.x() + e.cx, e.fy * d.y() + e.cy) - views_[view].eyes[eye][i]).squaredNorm();
  }
  return sum;
}

double EyesProblem::cost() const {
  double sum = 0;
  for (const CameraParameters& eye : now_.eyes)
    if (!(eye.fx > 0) || !(eye.fy > 0)) return kNone;
  for (std::size_t view = 0; view < views_.size(); ++view)
    for (std::size_t eye = 0; eye < now_.eyes.size(); ++eye) sum += weight(eye) * cost_of(view, eye);
  return sum;
}

void EyesProblem::add_view(std::size_t view, std::size_t eye, NormalEquations& equations) const {
  const SE3& T_left_board = now_.T_left_board[view];
  const Eigen::Matrix3d R_board = T_left_board.rotation(), R_right = now_.T_right_left.rotation();
  Eigen::RowVectorXd shared(unknowns());
  for (std::size_t i = 0; i < board_.corners(); ++i) {
    const Eigen::Vector3d on_board = board_.corner(i), left = T_left_board * on_board;
    const auto seen = see(now_.eyes[eye], eye == 0 ? left : now_.T_right_left * left);
    if (!seen) continue;  // cost() has refused it
    Eigen::Matrix<double, 3, 6> by_pose, by_right;
    by_pose << R_board, -R_board * hat(on_board);
    by_right << R_right, -R_right * hat(left);
    if (eye == 1) by_pose = (R_right * by_pose).eval();
    const Eigen::Matrix<double, 2, 6> pose = seen->by_point * by_pose, right = seen->by_point * by_right;
    const Eigen::Vector2d residual = seen->pixel - views_[view].eyes[eye][i];
    for (Eigen::Index k = 0; k < 2; ++k) {
      shared.setZero();
      if (!now_.eyes_known)
        shared.segment<kEyeUnknowns>(kEyeUnknowns * static_cast<Eigen::Index>(eye)) = seen->by_eye.row(k);
      if (eye == 1) shared.tail<6>() = right.row(k);
      equations.add(view, shared, pose.row(k), residual[k], weight(eye));
    }
  }
}

NormalEquations EyesProblem::linearise() const {
  NormalEquations equations(unknowns(), views_.size());
  for (std::size_t view = 0; view < views_.size(); ++view)
    for (std::size_t eye = 0; eye < now_.eyes.size(); ++eye) add_view(view, eye, equations);
  return equations;
}

EyesProblem EyesProblem::moved(const Step& step) const {
  EyesProblem next = *this;
  for (std::size_t eye = 0; eye < now_.eyes.size() && !now_.eyes_known; ++eye)
    change(next.now_.eyes[eye], step.shared.segment(kEyeUnknowns * static_cast<Eigen::Index>(eye), kEyeUnknowns));
  if (now_.eyes.size() > 1) next.now_.T_right_left = now_.T_right_left * SE3::exp(Vector6(step.shared.tail<6>()));
  for (std::size_t view = 0; view < views_.size(); ++view)
    next.now_.T_left_board[view] = now_.T_left_board[view] * SE3::exp(step.poses[view]);
  return next;
}

}  // namespace cairn::calibration
