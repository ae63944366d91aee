// SPDX-License-Identifier: Apache-2.0
// Accuracy of the visual odometry on recordings of stereo pictures with ground truth: drift, consistency of the
// covariance, CPU time.
//   visual_accuracy RECORDING… [KEY=VALUE …]
// TRACE=1 prints every picture. VisualOdometryConfig's keys, and: every=N takes every N-th picture; dark=S,L makes the
// pictures from second S on black for L seconds; restart=S,L lets it end at second S, and another one go on L seconds
// later from its last keyframes.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <memory>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "hal/clock.hpp"
#include "onboard/visual_odometry/stereo_odometry.hpp"
#include "tests/bench/flights/recorded_flight.hpp"

namespace cairn::visual_odometry {
namespace {

namespace fs = std::filesystem;
using flights::percentile;

struct Settings {
  VisualOdometryConfig odometry;
  int every = 1;
  double dark_from_s = -1, dark_for_s = 0;
  double restart_at_s = -1, restart_for_s = 0;
};

/// Where a picture was taken, and where odometry said so.
struct Pose {
  SE3 said, truth;
  double way_m = 0;
};

struct Figures {
  double length = 0, squared = 0, worst = 0, nees = 0, step_nees = 0, yaw_path = 0, worst_jump = 0;
  Eigen::Vector3d inside = Eigen::Vector3d::Zero();
  int frames = 0, lost = 0, keyframes = 0, all_inside = 0;
  double inliers = 0, rms_px = 0;
  std::vector<double> cpu_ms;
  std::vector<Pose> path;
  Vector6 error = Vector6::Zero(), sigma = Vector6::Zero();
};

void account(Figures& f, const VisualUpdate& u, const SE3& truth, const SE3& before) {
  ++f.frames;
  f.length += (before.inverse() * truth).translation().norm();
  f.path.push_back({u.T_odom_base.mean, truth, f.length});
  f.error = (u.T_odom_base.mean.inverse() * truth).log();
  f.sigma = u.T_odom_base.covariance.diagonal().cwiseSqrt();
  const double off = (u.T_odom_base.mean.translation() - truth.translation()).norm();
  f.squared += off * off;
  f.worst = std::max(f.worst, off);
  f.nees += f.error.dot(u.T_odom_base.covariance.ldlt().solve(f.error));
  const Vector6 step = (u.T_previous_base.mean.inverse() * (before.inverse() * truth)).log();
  f.step_nees += step.dot(u.T_previous_base.covariance.ldlt().solve(step));
  if (!u.lost) f.worst_jump = std::max(f.worst_jump, step.head<3>().norm());
  bool all = true;
  for (int k = 0; k < 6; ++k) {
    const bool in = std::abs(f.error[k]) < 3 * f.sigma[k];
    all = all && in;
    if (k < 3) f.inside[k] += in ? 1 : 0;
  }
  f.all_inside += all ? 1 : 0;
  f.lost += u.lost ? 1 : 0;
  f.keyframes += u.keyframe ? 1 : 0;
  f.inliers += u.inliers;
  f.rms_px += u.rms_px;
}

/// Root mean square of the error over pieces of the way of `piece_m`: a share of the piece, and degrees of tilt and
/// yaw. The mean of roll and pitch beside it shows what is systematic.
void print_pieces(const std::vector<Pose>& path, double piece_m) {
  Eigen::Vector3d squared = Eigen::Vector3d::Zero(), turned = Eigen::Vector3d::Zero();
  double pieces = 0;
  for (std::size_t i = 0, j = 0; i < path.size(); ++i) {
    while (j < path.size() && path[j].way_m - path[i].way_m < piece_m) ++j;
    if (j == path.size()) break;
    const SE3 said = path[i].said.inverse() * path[j].said, truth = path[i].truth.inverse() * path[j].truth;
    const Vector6 e = (said.inverse() * truth).log();
    squared += Eigen::Vector3d(e.head<3>().squaredNorm(), e.segment<2>(3).squaredNorm(), e[5] * e[5]);
    turned += e.tail<3>();
    ++pieces;
  }
  if (pieces == 0) return;
  const Eigen::Vector3d rms = (squared / pieces).cwiseSqrt();
  const Eigen::Vector3d mean = turned / pieces * 180 / std::numbers::pi;
  std::printf("  over %3.0f m: %.3f %%  tilt %.3f deg  yaw %.3f deg, mean roll %+.3f pitch %+.3f yaw %+.3f\n", piece_m,
              100 * rms[0] / piece_m, rms[1] * 180 / std::numbers::pi, rms[2] * 180 / std::numbers::pi, mean[0],
              mean[1], mean[2]);
}

void print(const std::string& name, const Figures& f) {
  const double n = f.frames, ate = std::sqrt(f.squared / n);
  std::printf(
      "%-28s %6.1f m  ATE %.3f m (%.2f %%) worst %.3f  yaw %.4f deg/m  tilt %.2f deg  jump %.3f | NEES/6 %.2f step "
      "%.2f in 3s x%.0f y%.0f z%.0f all %.0f | inl %.0f rms %.2f px lost %d kf %d/%d | ms p50 %.1f p99 %.1f max %.1f\n",
      name.c_str(), f.length, ate, 100 * ate / f.length, f.worst,
      std::abs(f.error[5]) * 180 / std::numbers::pi / f.length, f.error.segment<2>(3).norm() * 180 / std::numbers::pi,
      f.worst_jump, f.nees / n / 6, f.step_nees / n / 6, 100 * f.inside[0] / n, 100 * f.inside[1] / n,
      100 * f.inside[2] / n, 100 * f.all_inside / n, f.inliers / n, f.rms_px / n, f.lost, f.keyframes, f.frames,
      percentile(f.cpu_ms, 0.5), percentile(f.cpu_ms, 0.99), percentile(f.cpu_ms, 1));
  std::fflush(stdout);
}

Image decoded(const fs::path& file, std::int64_t ns, bool dark) {
  cv::Mat picture = cv::imread(file.string(), cv::IMREAD_COLOR);
  if (dark) cv::randn(picture, cv::Scalar::all(4), cv::Scalar::all(2));
  return flights::image_of(picture, ns);
}

void trace(double s, const VisualUpdate& u, const Figures& f) {
  std::printf(
      "%.2f s followed %d inliers %d rms %.2f it %d kf %d lost %d err %.3f %.3f %.3f r %.4f %.4f %.4f sig %.3f %.3f "
      "%.3f speed %.2f\n",
      s, u.followed, u.inliers, u.rms_px, u.iterations, u.keyframe, u.lost, f.error[0], f.error[1], f.error[2],
      f.error[3], f.error[4], f.error[5], f.sigma[0], f.sigma[1], f.sigma[2], u.twist.head<3>().norm());
}

/// What a restarted odometry goes on from.
struct Kept {
  std::deque<Keyframe> keyframes;
  UncertainPose T_odom_base;
  Vector6 twist = Vector6::Zero();
  Time stamp{};

  void keep(const StereoOdometry& odometry, const VisualUpdate& u) {
    if (u.lost) return;
    T_odom_base = u.T_odom_base;
    twist = u.twist;
    stamp = u.stamp;
    if (odometry.new_keyframe() == nullptr) return;
    keyframes.push_back(*odometry.new_keyframe());
    if (keyframes.size() > PlaceMemory::kPlaces) keyframes.pop_front();
  }
  void give_to(StereoOdometry& odometry) const {
    const std::vector<Keyframe> last(keyframes.begin(), keyframes.end());
    odometry.resume(T_odom_base, twist, stamp, last);
  }
};

std::unique_ptr<StereoOdometry> begin_anew(const flights::Eyes& eyes, const Settings& settings) {
  return std::make_unique<StereoOdometry>(settings.odometry, eyes.rectifier.geometry(), eyes.T_base_eye);
}

void run(const fs::path& recording, const Settings& settings) {
  const auto eyes = flights::eyes_of(recording);
  if (!eyes) return (void)std::printf("%s\n", to_string(eyes.error()).c_str());
  auto odometry = begin_anew(*eyes, settings);
  Kept kept;
  bool restarted = settings.restart_at_s < 0;
  const flights::Truth truth = flights::load_truth(recording / "ground_truth.tum");
  const auto pictures = flights::pictures_of(recording);
  const SE3 T_start = truth.at(pictures.front().first);
  Figures figures;
  SE3 before;
  stereo::StereoPair pair;
  for (std::size_t i = 0; i < pictures.size(); i += static_cast<std::size_t>(settings.every)) {
    const auto& [ns, file] = pictures[i];
    const double s = static_cast<double>(ns - pictures.front().first) * 1e-9;
    if (s >= settings.restart_at_s && s < settings.restart_at_s + settings.restart_for_s) continue;
    if (!restarted && s >= settings.restart_at_s) {
      odometry = begin_anew(*eyes, settings);
      kept.give_to(*odometry);
      restarted = true;
    }
    const bool dark = s >= settings.dark_from_s && s < settings.dark_from_s + settings.dark_for_s;
    const Image image = decoded(file, ns, dark);
    const Duration begin = thread_cpu_time();
    if (const auto done = eyes->rectifier.rectify(image, pair); !done) return;
    Budget budget = Budget::steps(most_steps(settings.odometry));
    const auto u = odometry->update(pair, budget);
    figures.cpu_ms.push_back(to_milliseconds(thread_cpu_time() - begin));
    if (!u) return (void)std::printf("%s\n", to_string(u.error()).c_str());
    kept.keep(*odometry, *u);
    const SE3 now = T_start.inverse() * truth.at(ns);
    if (i > 0) account(figures, *u, now, before);
    before = now;
    if (std::getenv("TRACE") != nullptr) trace(s, *u, figures);
  }
  print(recording.parent_path().parent_path().filename().string(), figures);
  for (const double piece_m : {5.0, 20.0, 60.0}) print_pieces(figures.path, piece_m);
}

bool set(const std::string& key, const std::string& value, Settings& s) {
  if (key == "every") return (s.every = std::stoi(value)) > 0;
  if (key == "restart") return std::sscanf(value.c_str(), "%lf,%lf", &s.restart_at_s, &s.restart_for_s) == 2;
  if (key == "dark") return std::sscanf(value.c_str(), "%lf,%lf", &s.dark_from_s, &s.dark_for_s) == 2;
  config::Section section;
  declare(section, s.odometry);
  return config::parse(key + ": " + value, "arguments", section).has_value();
}

int main_program(int argc, char** argv) {
  Settings settings;
  std::vector<fs::path> recordings;
  const auto known = [&](const std::string& key, const std::string& value) { return set(key, value, settings); };
  if (!flights::read_arguments({argv + 1, argv + argc}, recordings, known)) return 2;
  cv::setNumThreads(1);
  for (const fs::path& recording : recordings) run(recording, settings);
  return 0;
}

}  // namespace
}  // namespace cairn::visual_odometry

int main(int argc, char** argv) { return cairn::visual_odometry::main_program(argc, argv); }
