// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/lidar_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "onboard/perception/calibration/eyes_problem.hpp"
#include "onboard/perception/calibration/mount_deviations.hpp"

namespace cairn::calibration {
namespace {

using cameras::CameraModel;

constexpr int kNoiseRounds = 4;
// Distances from the board within which points count as on it, from round to round.
constexpr std::array kDepths_m{0.10, 0.06, 0.05};
// With larger deviations than these the points are not searched for again.
constexpr double kFreePlace_m = 0.1, kFreeTurn_deg = 2;
// A pose is dropped if its points are so many times farther from the plane than the median pose's, and so far.
constexpr double kOutlierPose = 2.5, kLeastOutlierPose_m = 0.02, kLeastOutlierPose_px = 0.3;

/// Poses that take part, and the state of the adjustment.
struct Working {
  std::vector<std::size_t> index;
  std::vector<BoardPose> poses;
  PlaneProblem::State state;
};

SE3 expected(const Working& w, std::size_t i) {
  return w.state.T_optical_points.inverse() * w.state.T_optical_board[i];
}

/// First round: the planes near the boards. Poses without one are named.
Working begin(std::span<const BoardPose> given, const Board& board, const CameraModel& eye, const SE3& T_optical_points,
              const MountTolerance& tolerance, std::vector<std::size_t>& no_plane) {
  Working w{.index = {}, .poses = {}, .state = {.T_optical_points = T_optical_points, .T_optical_board = {}}};
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto T_optical_board = board_pose(eye.parameters(), board, given[i].corners);
    Points plane;
    if (T_optical_board) plane = board_plane(given[i].points, T_optical_points.inverse() * *T_optical_board, tolerance);
    if (plane.empty()) {
      no_plane.push_back(i);
      continue;
    }
    w.index.push_back(i);
    w.poses.push_back({.corners = given[i].corners, .points = std::move(plane)});
    w.state.T_optical_board.push_back(*T_optical_board);
  }
  return w;
}

void erase(Working& w, std::size_t i) {
  const auto at = static_cast<std::ptrdiff_t>(i);
  w.index.erase(w.index.begin() + at);
  w.poses.erase(w.poses.begin() + at);
  w.state.T_optical_board.erase(w.state.T_optical_board.begin() + at);
}

/// Later rounds: the points on the squares, where the boards are now thought to be.
void take_points(Working& w, std::span<const BoardPose> given, const Board& board, double depth_m,
                 std::vector<std::size_t>& no_plane) {
  for (std::size_t i = w.index.size(); i-- > 0;) {
    w.poses[i].points = on_squares(given[w.index[i]].points, board, expected(w, i), depth_m);
    if (w.poses[i].points.size() >= kLeastPoints) continue;
    no_plane.push_back(w.index[i]);
    erase(w, i);
  }
}

PlaneProblem solve(const Working& w, const Board& board, const CameraModel& eye) {
  PlaneProblem problem(board, w.poses, eye.parameters(), w.state, {});
  for (int round = 0; round < kNoiseRounds; ++round) {
    (void)minimise(problem);
    problem = problem.with_noise_of_residuals();
  }
  return problem;
}

double point_rms(const PlaneProblem& problem, const Working& w, std::size_t pose) {
  double squares = 0;
  for (const Eigen::Vector3d& p : w.poses[pose].points) squares += std::pow(problem.distance(pose, p), 2);
  return std::sqrt(squares / static_cast<double>(w.poses[pose].points.size()));
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Takes away the pose that fits worst, if it does not fit the others. A wrong pose bends either its points or its
/// corners.
bool drop_worst(const PlaneProblem& problem, Working& w, std::vector<std::size_t>& dropped) {
  std::vector<double> points, corners;
  for (std::size_t i = 0; i < w.poses.size(); ++i) {
    points.push_back(point_rms(problem, w, i));
    corners.push_back(std::sqrt(0.5 * problem.corner_squares(i) / static_cast<double>(w.poses[i].corners.size())));
  }
  const double most_m = std::max(kLeastOutlierPose_m, kOutlierPose * median(points));
  const double most_px = std::max(kLeastOutlierPose_px, kOutlierPose * median(corners));
  std::size_t worst = 0;
  double most = 1;
  for (std::size_t i = 0; i < w.poses.size(); ++i) {
    const double error = std::max(points[i] / most_m, corners[i] / most_px);
    if (error <= most) continue;
    most = error;
    worst = i;
  }
  if (most <= 1) return false;
  dropped.push_back(w.index[worst]);
  erase(w, worst);
  return true;
}

Error too_few(std::size_t given, const Working& w, const MountCalibration& m) {
  return {
      Errc::kNotFound,
      "too few poses of the board",
      {},
      {},
      fmt::format("{} of {} can be used, at least {} are needed ({} without a plane in the scans, {} do not fit the "
                  "others): hold the board still for a second each, away from other things; check T_base_camera, "
                  "intrinsics and --square-m",
                  w.poses.size(), given, kLeastPoses, m.no_plane.size(), m.dropped.size())};
}

/// Whether a direction is so free that the mount slides away from the board's points.
bool is_free(const PlaneProblem& problem) {
  const SE3 T_points_camera = problem.now().T_optical_points.inverse() * cameras::T_camera_optical().inverse();
  const Vector6 d = mount_deviations(T_points_camera, covariance(problem.linearise().information(), 1));
  return !(d.head<3>().maxCoeff() < kFreePlace_m && d.tail<3>().maxCoeff() < kFreeTurn_deg * kDegree);
}

void describe(MountCalibration& m, const PlaneProblem& problem, const Working& w, const Board& board,
              const CameraModel& eye) {
  m.used = w.index;
  m.T_points_camera = problem.now().T_optical_points.inverse() * cameras::T_camera_optical().inverse();
  m.deviations = mount_deviations(m.T_points_camera, covariance(problem.linearise().information(), 1));
  double point_squares = 0, corner_squares = 0;
  std::vector<Corners> views;
  for (std::size_t i = 0; i < w.poses.size(); ++i) {
    const auto count = static_cast<double>(w.poses[i].points.size());
    point_squares += count * std::pow(point_rms(problem, w, i), 2);
    corner_squares += problem.corner_squares(i);
    m.points += w.poses[i].points.size();
    views.push_back(w.poses[i].corners);
  }
  m.point_rms_m = std::sqrt(point_squares / static_cast<double>(m.points));
  m.corner_rms_px = std::sqrt(corner_squares / (2 * static_cast<double>(board.corners() * w.poses.size())));
  m.coverage = coverage(views, problem.now().T_optical_board, eye.width(), eye.height());
}

MountCalibration finished(MountCalibration m, const PlaneProblem& problem, const Working& w, const Board& board,
                          const CameraModel& eye, const MountLimits& limits) {
  describe(m, problem, w, board, eye);
  m.faults = mount_faults(m.deviations, limits);
  return m;
}

}  // namespace

Result<MountCalibration> calibrate_mount(const Board& board, std::span<const BoardPose> poses, const CameraModel& eye,
                                         const SE3& T_points_camera, const MountTolerance& tolerance,
                                         const MountLimits& limits) {
  MountCalibration m;
  const SE3 T_optical_points = (T_points_camera * cameras::T_camera_optical()).inverse();
  Working w = begin(poses, board, eye, T_optical_points, tolerance, m.no_plane);
  for (std::size_t round = 0;;) {
    if (w.poses.size() < kLeastPoses) return too_few(poses.size(), w, m);
    const PlaneProblem problem = solve(w, board, eye);
    if (!std::isfinite(problem.cost()))
      return Error{Errc::kDiverged, "no mount explains these poses", {}, {}, "check T_base_camera and intrinsics"};
    w.state = problem.now();
    if (round == 0 && is_free(problem)) return finished(std::move(m), problem, w, board, eye, limits);
    const bool fits = !drop_worst(problem, w, m.dropped);
    if (fits && round == kDepths_m.size()) return finished(std::move(m), problem, w, board, eye, limits);
    if (fits) ++round;
    if (round > 0) take_points(w, poses, board, kDepths_m[round - 1], m.no_plane);
  }
}

}  // namespace cairn::calibration
