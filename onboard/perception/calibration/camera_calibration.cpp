// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/camera_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace cairn::calibration {
namespace {

using cameras::CameraParameters;
using cameras::DistortionModel;

constexpr std::array kStarts{0.4, 0.7, 1.2, 2.2};  // focal lengths as shares of the picture's width
constexpr int kFirstSteps = 12;
// A view is dropped if its error is more than so many times the median one, and more than so many pixels.
constexpr double kOutlierView = 3, kLeastOutlierView_px = 0.3;

std::optional<EyesProblem> start_at(const Board& board, std::span<const View> views, const CameraParameters& eye) {
  EyesProblem::Start start{.eyes = {eye}, .T_right_left = {}, .T_left_board = {}};
  for (const View& view : views) {
    const auto T = board_pose(eye, board, view.eyes[0]);
    if (!T) return {};
    start.T_left_board.push_back(*T);
  }
  return EyesProblem(board, views, std::move(start));
}

std::optional<EyesProblem> solve(const Board& board, std::span<const View> views, CameraParameters eye) {
  std::optional<EyesProblem> best;
  for (const double share : kStarts) {
    eye.fx = eye.fy = share * eye.width;
    auto problem = start_at(board, views, eye);
    if (!problem) continue;
    (void)minimise(*problem, kFirstSteps);
    if (!best || problem->cost() < best->cost()) best = std::move(problem);
  }
  if (best) (void)minimise(*best);
  return best;
}

double rms(double cost, std::size_t corners) { return std::sqrt(cost / (2 * static_cast<double>(corners))); }

/// Views that do not fit the others.
std::vector<std::size_t> outliers(const EyesProblem& problem, std::size_t views, std::size_t corners) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < views; ++i) errors.push_back(rms(problem.cost_of(i, 0), corners));
  std::vector<double> sorted = errors;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(views / 2), sorted.end());
  const double most = std::max(kLeastOutlierView_px, kOutlierView * sorted[views / 2]);
  std::vector<std::size_t> bad;
  for (std::size_t i = 0; i < views; ++i)
    if (errors[i] > most) bad.push_back(i);
  return bad;
}

/// The views that fit each other, and the solution for them.
struct Fit {
  std::vector<View> views;
  std::vector<std::size_t> index;  // of the views in those that were given
  std::vector<std::size_t> dropped;
  std::optional<EyesProblem> problem;
};

Fit fit(const Board& board, std::span<const Corners> given, const CameraParameters& eye) {
  Fit f;
  for (std::size_t i = 0; i < given.size(); ++i) {
    f.views.push_back({.eyes = {given[i]}});
    f.index.push_back(i);
  }
  for (int round = 0; round < 4; ++round) {
    f.problem = solve(board, f.views, eye);
    if (!f.problem) return f;
    const auto bad = outliers(*f.problem, f.views.size(), board.corners());
    if (bad.empty() || f.views.size() - bad.size() < kLeastViews) return f;
    f.problem.reset();  // it looks at the views
    for (auto i = bad.rbegin(); i != bad.rend(); ++i) {
      f.dropped.push_back(f.index[*i]);
      f.views.erase(f.views.begin() + static_cast<std::ptrdiff_t>(*i));
      f.index.erase(f.index.begin() + static_cast<std::ptrdiff_t>(*i));
    }
  }
  f.problem = solve(board, f.views, eye);
  return f;
}

/// Standard deviation of the pixel to which an eye takes the ray of this pixel.
double pixel_deviation(const CameraParameters& eye, const Eigen::MatrixXd& covariance, const Eigen::Vector2d& pixel) {
  const auto model = cameras::CameraModel::create(eye);
  const auto ray = model ? model->unproject(pixel) : std::nullopt;
  const auto seen = ray ? see(eye, *ray) : std::nullopt;
  if (!seen) return 0;  // no ray goes there
  const Eigen::Matrix2d spread = seen->by_eye * covariance * seen->by_eye.transpose();
  return std::sqrt(std::max(spread(0, 0), spread(1, 1)));
}

CameraCalibration describe(const Board& board, const Fit& f, std::span<const Corners> given,
                           const CameraLimits& limits) {
  const EyesProblem& problem = *f.problem;
  const double cost = problem.cost();
  const Eigen::MatrixXd sigma = covariance(problem.linearise().information(), cost / problem.degrees_of_freedom());
  CameraCalibration c{.eye = estimate_of(problem.now().eyes[0], sigma),
                      .views = {},
                      .dropped = f.dropped,
                      .coverage = {},
                      .T_optical_board = problem.now().T_left_board,
                      .faults = {}};
  c.eye.rms_px = rms(cost, board.corners() * f.views.size());
  std::vector<Corners> used;
  for (std::size_t i = 0; i < f.views.size(); ++i) {
    c.views.push_back({.view = f.index[i], .rms_px = rms(problem.cost_of(i, 0), board.corners())});
    used.push_back(given[f.index[i]]);
  }
  c.coverage = coverage(used, c.T_optical_board, c.eye.parameters.width, c.eye.parameters.height);
  c.faults = faults_of(c.eye, limits);
  return c;
}

}  // namespace

std::array<std::string_view, kEyeUnknowns> unknown_names(DistortionModel model) {
  if (model == DistortionModel::kEquidistant) return {"fx", "fy", "cx", "cy", "k1", "k2", "k3", "k4"};
  return {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"};
}

EyeEstimate estimate_of(const CameraParameters& eye, const Eigen::MatrixXd& covariance) {
  EyeEstimate e{.parameters = eye, .covariance = covariance};
  for (const double u : {-0.5, eye.width - 0.5})
    for (const double v : {-0.5, eye.height - 0.5})
      e.corner_deviation_px = std::max(e.corner_deviation_px, pixel_deviation(eye, covariance, {u, v}));
  return e;
}

std::vector<std::string> faults_of(const EyeEstimate& eye, const CameraLimits& limits) {
  const CameraParameters& p = eye.parameters;
  std::vector<std::string> faults;
  const auto check = [&](const char* name, double deviation, double whole, double limit, const char* of) {
    if (deviation <= limit * whole) return;
    const std::string known = std::isfinite(deviation) ? fmt::format("only known to {:.2g} %", 100 * deviation / whole)
                                                       : std::string("not determined at all");
    faults.push_back(fmt::format("{} is {}{}, the limit is {:.2g} %", name, known, of, 100 * limit));
  };
  check("fx", eye.deviation(0), p.fx, limits.focal, "");
  check("fy", eye.deviation(1), p.fy, limits.focal, "");
  check("cx", eye.deviation(2), p.width, limits.centre, " of the picture's width");
  check("cy", eye.deviation(3), p.height, limits.centre, " of the picture's height");
  check("the place of a pixel in the picture's corners", eye.corner_deviation_px, p.width, limits.corner,
        " of the picture's width");
  if (const auto model = cameras::CameraModel::create(p); !model)
    faults.push_back("the numbers are no lens: " + to_string(model.error()));
  return faults;
}

Result<CameraCalibration> calibrate_camera(const Board& board, std::span<const Corners> views, int width, int height,
                                           DistortionModel model, const CameraLimits& limits) {
  if (views.size() < kLeastViews)
    return Error{Errc::kNotFound,
                 "too few different views of the board",
                 {},
                 {},
                 fmt::format("{}, at least {} are needed: move and tilt the board more", views.size(), kLeastViews)};
  const CameraParameters eye{.width = width,
                             .height = height,
                             .fx = 0,
                             .fy = 0,
                             .cx = 0.5 * (width - 1),
                             .cy = 0.5 * (height - 1),
                             .distortion = {.model = model}};
  const Fit f = fit(board, views, eye);
  if (!f.problem) return Error{Errc::kDiverged, "no lens explains these views", {}, {}, "check --board and --model"};
  return describe(board, f, views, limits);
}

}  // namespace cairn::calibration
