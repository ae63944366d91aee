// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/pair_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "onboard/perception/calibration/eyes_problem.hpp"
#include "onboard/perception/calibration/mount_deviations.hpp"

namespace cairn::calibration {
namespace {

using cameras::CameraModel;

constexpr int kPairRounds = 3;
constexpr double kSurestCorner_px = 1e-3;  // noise of corners, at least
// A view is dropped if it fits so many times worse than the median one, and so many pixels.
constexpr double kOutlierPairView = 3, kLeastOutlierPairView_px = 0.3;

/// Views that take part, and where each camera alone sees their boards.
struct Shared {
  std::vector<std::size_t> index;
  std::vector<View> views;
  std::vector<SE3> T_first_board, T_second_board;
};

Shared shared_views(const Board& board, std::span<const PairView> given, const CameraModel& first,
                    const CameraModel& second) {
  Shared w;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto in_first = board_pose(first.parameters(), board, given[i].first);
    const auto in_second = board_pose(second.parameters(), board, given[i].second);
    if (!in_first || !in_second) continue;
    w.index.push_back(i);
    w.views.push_back({.eyes = {given[i].first, given[i].second}});
    w.T_first_board.push_back(*in_first);
    w.T_second_board.push_back(*in_second);
  }
  return w;
}

void leave_out(Shared& w, std::size_t i) {
  const auto at = static_cast<std::ptrdiff_t>(i);
  w.index.erase(w.index.begin() + at);
  w.views.erase(w.views.begin() + at);
  w.T_first_board.erase(w.T_first_board.begin() + at);
  w.T_second_board.erase(w.T_second_board.begin() + at);
}

/// Starts at the view whose pose of the second camera fits all views best.
EyesProblem start_at_best(const Board& board, const Shared& w, const CameraModel& first, const CameraModel& second) {
  EyesProblem::Start values{.eyes = {first.parameters(), second.parameters()},
                            .T_right_left = {},
                            .T_left_board = w.T_first_board,
                            .eyes_known = true};
  EyesProblem best(board, w.views, values);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < w.views.size(); ++i) {
    values.T_right_left = w.T_second_board[i] * w.T_first_board[i].inverse();
    EyesProblem here(board, w.views, values);
    const double cost = here.cost();
    if (cost >= least) continue;
    least = cost;
    best = std::move(here);
  }
  return best;
}

/// Root of the mean squared distance of a corner along one axis, pixels.
double corner_rms(const EyesProblem& problem, std::size_t view, std::size_t eye, const Board& board) {
  return std::sqrt(problem.cost_of(view, eye) / (2 * static_cast<double>(board.corners())));
}

double corner_rms(const EyesProblem& problem, const Shared& w, std::size_t eye, const Board& board) {
  double squares = 0;
  for (std::size_t i = 0; i < w.views.size(); ++i) squares += std::pow(corner_rms(problem, i, eye, board), 2);
  return std::sqrt(squares / static_cast<double>(w.views.size()));
}

EyesProblem solve_pair(const Board& board, const Shared& w, const CameraModel& first, const CameraModel& second) {
  EyesProblem problem = start_at_best(board, w, first, second);
  for (int round = 0; round < kPairRounds; ++round) {
    (void)minimise(problem);
    EyesProblem::Start now = problem.now();
    for (std::size_t eye = 0; eye < 2; ++eye)
      now.corner_px[eye] = std::max(kSurestCorner_px, corner_rms(problem, w, eye, board));
    problem = EyesProblem(board, w.views, std::move(now));
  }
  return problem;
}

/// Takes away the view that fits worst, if it does not fit the others.
bool drop_worst_view(const EyesProblem& problem, const Board& board, Shared& w, std::vector<std::size_t>& dropped) {
  std::optional<std::size_t> worst;
  double most = 1;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < w.views.size(); ++i) errors.push_back(corner_rms(problem, i, eye, board));
    std::vector<double> sorted = errors;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double limit = std::max(kLeastOutlierPairView_px, kOutlierPairView * *middle);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      if (errors[i] / limit <= most) continue;
      most = errors[i] / limit;
      worst = i;
    }
  }
  if (!worst) return false;
  dropped.push_back(w.index[*worst]);
  leave_out(w, *worst);
  return true;
}

PairCalibration describe_pair(const EyesProblem& problem, const Board& board, const Shared& w,
                              const CameraModel& second, const MountLimits& limits) {
  PairCalibration c;
  // The frame of the first camera's body takes the place of the points' frame.
  const SE3 body = cameras::T_camera_optical(), T_second_first = problem.now().T_right_left * body.inverse();
  c.T_first_second = (body * T_second_first).inverse();
  const Matrix6 Ad = body.adjoint();
  c.deviations = mount_deviations(c.T_first_second,
                                  Ad * Matrix6(covariance(problem.linearise().information(), 1)) * Ad.transpose());
  c.used = w.index;
  std::vector<Corners> seen;
  std::vector<SE3> T_second_board;
  for (std::size_t i = 0; i < w.views.size(); ++i) {
    seen.push_back(w.views[i].eyes[1]);
    T_second_board.push_back(problem.now().T_right_left * problem.now().T_left_board[i]);
  }
  for (std::size_t eye = 0; eye < 2; ++eye) c.corner_rms_px[eye] = corner_rms(problem, w, eye, board);
  c.coverage = coverage(seen, T_second_board, second.width(), second.height());
  c.faults = mount_faults(c.deviations, limits);
  return c;
}

Error too_few_views(std::size_t given, std::size_t usable) {
  return {Errc::kNotFound,
          "too few views that both cameras share",
          {},
          {},
          fmt::format("{} of {} can be used, at least {} are needed: hold the board still where both see all of it; "
                      "check both intrinsics and --square-m",
                      usable, given, kLeastPoses)};
}

}  // namespace

Result<PairCalibration> calibrate_pair(const Board& board, std::span<const PairView> views, const CameraModel& first,
                                       const CameraModel& second, const MountLimits& limits) {
  Shared w = shared_views(board, views, first, second);
  std::vector<std::size_t> dropped;
  for (;;) {
    if (w.views.size() < kLeastPoses) return too_few_views(views.size(), w.views.size());
    const EyesProblem problem = solve_pair(board, w, first, second);
    if (!std::isfinite(problem.cost()))
      return Error{Errc::kDiverged, "no mount explains these views", {}, {}, "check both intrinsics"};
    if (drop_worst_view(problem, board, w, dropped)) continue;
    PairCalibration c = describe_pair(problem, board, w, second, limits);
    c.dropped = std::move(dropped);
    return c;
  }
}

}  // namespace cairn::calibration
