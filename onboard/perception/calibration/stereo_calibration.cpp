// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/stereo_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cairn::calibration {
namespace {

using cameras::CameraModel;
using cameras::DistortionModel;

/// Views that both eyes use, and where the board is in them.
struct Common {
  std::vector<std::size_t> index;
  std::vector<View> views;
  std::vector<SE3> T_left_board, T_right_board;
};

Common common_views(const CameraCalibration& left, const CameraCalibration& right, std::span<const Corners> in_left,
                    std::span<const Corners> in_right) {
  Common c;
  for (std::size_t i = 0; i < left.views.size(); ++i) {
    const std::size_t view = left.views[i].view;
    const auto same =
        std::find_if(right.views.begin(), right.views.end(), [&](const ViewError& v) { return v.view == view; });
    if (same == right.views.end()) continue;
    c.index.push_back(view);
    c.views.push_back({.eyes = {in_left[view], in_right[view]}});
    c.T_left_board.push_back(left.T_optical_board[i]);
    c.T_right_board.push_back(right.T_optical_board[static_cast<std::size_t>(same - right.views.begin())]);
  }
  return c;
}

/// Starts at the view whose T_right_left fits all views best.
EyesProblem start(const Board& board, const Common& c, const CameraCalibration& left, const CameraCalibration& right) {
  EyesProblem best(
      board, c.views,
      {.eyes = {left.eye.parameters, right.eye.parameters}, .T_right_left = {}, .T_left_board = c.T_left_board});
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < c.views.size(); ++i) {
    auto values = best.now();
    values.T_right_left = c.T_right_board[i] * c.T_left_board[i].inverse();
    EyesProblem here(board, c.views, std::move(values));
    const double cost = here.cost();
    if (cost >= least) continue;
    least = cost;
    best = std::move(here);
  }
  return best;
}

/// Sum of squared distances from epipolar lines, in pixels of the right eye.
double epipolar_squares(const CameraModel& left, const CameraModel& right, const SE3& T_right_left, const View& view) {
  const Eigen::Matrix3d essential = hat(T_right_left.translation()) * T_right_left.rotation();
  const double focal = 0.5 * (right.parameters().fx + right.parameters().fy);
  double squares = 0;
  for (std::size_t i = 0; i < view.eyes[0].size(); ++i) {
    const auto a = left.unproject(view.eyes[0][i]), b = right.unproject(view.eyes[1][i]);
    if (!a || !b || !(b->z() > 0)) continue;
    const Eigen::Vector3d line = essential * *a;
    squares += std::pow(focal * line.dot(*b / b->z()) / line.head<2>().norm(), 2);
  }
  return squares;
}

double epipolar_rms(const EyesProblem& problem, const Common& c) {
  const auto left = CameraModel::create(problem.now().eyes[0]), right = CameraModel::create(problem.now().eyes[1]);
  if (!left || !right) return std::numeric_limits<double>::infinity();
  double squares = 0, count = 0;
  for (const View& view : c.views) {
    squares += epipolar_squares(*left, *right, problem.now().T_right_left, view);
    count += static_cast<double>(view.eyes[0].size());
  }
  return std::sqrt(squares / count);
}

void find_faults(StereoCalibration& s, const StereoLimits& limits) {
  for (std::size_t eye = 0; eye < 2; ++eye)
    for (const std::string& fault : faults_of(s.eyes[eye], limits.eye))
      s.faults.push_back(std::string(eye == 0 ? "left eye: " : "right eye: ") + fault);
  if (!(s.baseline_deviation_m <= limits.baseline * s.baseline_m))
    s.faults.push_back(fmt::format("the baseline is only known to {:.2g} %, the limit is {:.2g} %",
                                   100 * s.baseline_deviation_m / s.baseline_m, 100 * limits.baseline));
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    if (!(s.rotation_deviation_deg(axis) <= limits.rotation_deg))
      s.faults.push_back(fmt::format("the rotation about {} is only known to {:.2g} degrees, the limit is {:.2g}",
                                     "xyz"[axis], s.rotation_deviation_deg(axis), limits.rotation_deg));
}

/// Baseline: the right eye stands at -R^T t in the left one's frame.
void measure_baseline(StereoCalibration& s) {
  const Eigen::Vector3d centre = s.T_right_left.inverse().translation(), along = centre.normalized();
  Vector6 by;
  by << -along, -hat(centre) * along;
  s.baseline_m = centre.norm();
  s.baseline_deviation_m = std::sqrt(by.dot(s.covariance * by));
}

StereoCalibration describe(const Board& board, const EyesProblem& problem, const Common& c,
                           const StereoLimits& limits) {
  const double cost = problem.cost();
  const Eigen::MatrixXd sigma = covariance(problem.linearise().information(), cost / problem.degrees_of_freedom());
  StereoCalibration s{};
  s.T_right_left = problem.now().T_right_left;
  s.covariance = sigma.bottomRightCorner<6, 6>();
  const double corners = 2 * static_cast<double>(board.corners());
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const auto first = kEyeUnknowns * static_cast<Eigen::Index>(eye);
    s.eyes[eye] = estimate_of(problem.now().eyes[eye], sigma.block(first, first, kEyeUnknowns, kEyeUnknowns));
    double squares = 0;
    for (std::size_t i = 0; i < c.views.size(); ++i) squares += problem.cost_of(i, eye);
    s.eyes[eye].rms_px = std::sqrt(squares / (corners * static_cast<double>(c.views.size())));
  }
  for (std::size_t i = 0; i < c.views.size(); ++i)
    s.views.push_back(
        {.view = c.index[i], .rms_px = std::sqrt((problem.cost_of(i, 0) + problem.cost_of(i, 1)) / (2 * corners))});
  measure_baseline(s);
  s.epipolar_rms_px = epipolar_rms(problem, c);
  find_faults(s, limits);
  return s;
}

}  // namespace

double StereoCalibration::rotation_deviation_deg(Eigen::Index axis) const {
  return std::sqrt(covariance(3 + axis, 3 + axis)) / kDegree;
}

Result<StereoCalibration> calibrate_stereo(const Board& board, std::span<const Corners> left,
                                           std::span<const Corners> right, int width, int height, DistortionModel model,
                                           const StereoLimits& limits) {
  const auto left_eye = calibrate_camera(board, left, width, height, model, limits.eye);
  if (!left_eye) return left_eye.error();
  const auto right_eye = calibrate_camera(board, right, width, height, model, limits.eye);
  if (!right_eye) return right_eye.error();
  const Common c = common_views(*left_eye, *right_eye, left, right);
  if (c.views.size() < kLeastViews)
    return Error{Errc::kNotFound,
                 "too few views in which both eyes fit",
                 {},
                 {},
                 fmt::format("{}, at least {} are needed", c.views.size(), kLeastViews)};
  EyesProblem problem = start(board, c, *left_eye, *right_eye);
  (void)minimise(problem);
  StereoCalibration s = describe(board, problem, c, limits);
  s.dropped = left_eye->dropped;
  s.dropped.insert(s.dropped.end(), right_eye->dropped.begin(), right_eye->dropped.end());
  std::sort(s.dropped.begin(), s.dropped.end());
  s.dropped.erase(std::unique(s.dropped.begin(), s.dropped.end()), s.dropped.end());
  s.coverage = left_eye->coverage;
  return s;
}

}  // namespace cairn::calibration
