// SPDX-License-Identifier: Apache-2.0
// Accuracy of the odometry in closed-form scenes and on KITTI: drift, consistency of the covariance, CPU time.
//   odometry_accuracy [scene|kitti|street22|all] [seconds] [seed] [key=value …]
#include <Eigen/Cholesky>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

#include "hal/clock.hpp"
#include "onboard/odometry/odometry.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/support/scenes.hpp"

namespace cairn::odometry {
namespace {

OdometryConfig g_config;

struct Figures {
  double length = 0, squared_error = 0, worst = 0, nees = 0, inside3 = 0, step_nees = 0, rms = 0, inliers = 0;
  Eigen::Vector3d inside_axis = Eigen::Vector3d::Zero();
  std::vector<double> cpu_ms;
  int n = 0, lost = 0, degenerate = 0, iterations = 0;
  Vector6 sigma = Vector6::Zero(), error = Vector6::Zero();
};

void print(const char* name, Figures& f) {
  std::sort(f.cpu_ms.begin(), f.cpu_ms.end());
  const auto q = [&](double s) {
    return f.cpu_ms[static_cast<std::size_t>(s * static_cast<double>(f.cpu_ms.size() - 1))];
  };
  std::printf(
      "%-9s len %6.2f ATE %.4f m (%.3f %%) worst %.3f end t %.3f %.3f %.3f r %.5f %.5f %.5f | sig t %.3f %.3f %.3f r "
      "%.5f %.5f %.5f | "
      "NEES/6 %.2f in3s x%.0f y%.0f z%.0f stepNEES/6 %.2f | it %.1f inl %.2f rms %.4f lost %d deg %d | ms p50 %.2f p99 "
      "%.2f max %.2f\n",
      name, f.length, std::sqrt(f.squared_error / f.n), 100 * std::sqrt(f.squared_error / f.n) / f.length, f.worst,
      f.error[0], f.error[1], f.error[2], f.error[3], f.error[4], f.error[5], f.sigma[0], f.sigma[1], f.sigma[2],
      f.sigma[3], f.sigma[4], f.sigma[5], f.nees / f.n / 6, 100 * f.inside_axis[0] / f.n, 100 * f.inside_axis[1] / f.n,
      100 * f.inside_axis[2] / f.n, f.step_nees / f.n / 6, double(f.iterations) / f.n, f.inliers / f.n, f.rms / f.n,
      f.lost, f.degenerate, q(0.5), q(0.99), q(1.0));
  std::fflush(stdout);
}

void account(Figures& f, const OdometryUpdate& u, const SE3& truth, const SE3& truth_before, bool first) {
  if (first) return;
  ++f.n;
  f.length += (truth_before.inverse() * truth).translation().norm();
  const Vector6 e = (u.T_odom_base.mean.inverse() * truth).log();
  f.error = e;
  f.sigma = u.T_odom_base.covariance.diagonal().cwiseSqrt();
  f.squared_error += (u.T_odom_base.mean.translation() - truth.translation()).squaredNorm();
  f.worst = std::max(f.worst, (u.T_odom_base.mean.translation() - truth.translation()).norm());
  f.nees += e.dot(u.T_odom_base.covariance.ldlt().solve(e));
  const Vector6 es = (u.T_previous_base.mean.inverse() * (truth_before.inverse() * truth)).log();
  f.step_nees += es.dot(u.T_previous_base.covariance.ldlt().solve(es));
  for (int k = 0; k < 3; ++k) f.inside_axis[k] += std::abs(e[k]) < 3 * f.sigma[k];
  f.lost += u.lost;
  f.degenerate += u.degenerate_directions > 0;
  f.iterations += u.iterations;
  f.rms += u.rms_m;
  f.inliers += u.inlier_ratio;
}

void run_scene(const support::Scene& scene, double seconds, unsigned seed) {
  Vector6 mount;
  mount << 0.2, 0, 0.6, 0, 0, 0;
  const SE3 T_base_lidar = SE3::from_xyz_rpy(mount);
  const support::RidePath path(scene.ride, seconds + 1);
  const SE3 T_start = path(support::Vlp16::kScanSeconds);
  support::Vlp16 lidar(T_base_lidar, 0.02, seed);
  Workers workers(1);
  LidarOdometry odometry(g_config, T_base_lidar, workers);
  Figures f;
  SE3 before;
  const bool trace = std::getenv("TRACE") != nullptr;
  for (int i = 0; i * support::Vlp16::kScanSeconds < seconds; ++i) {
    const double start = i * support::Vlp16::kScanSeconds;
    const Scan scan = lidar.scan(scene.world, path, start);
    const SE3 truth = T_start.inverse() * path(start + support::Vlp16::kScanSeconds);
    Budget budget = Budget::steps(most_steps(g_config));
    const Duration t0 = thread_cpu_time();
    const auto u = odometry.update(scan, budget);
    f.cpu_ms.push_back(to_milliseconds(thread_cpu_time() - t0));
    if (!u) return (void)std::printf("error %s\n", to_string(u.error()).c_str());
    account(f, *u, truth, before, i == 0);
    if (trace && i > 0) {
      const Vector6 es = (u->T_previous_base.mean.inverse() * (before.inverse() * truth)).log();
      std::printf(
          "%d pts %zu it %d inl %.2f rms %.4f deg %d lost %d step err %.5f %.5f %.5f | %.6f %.6f %.6f  err %.4f %.4f "
          "%.4f sig %.4f %.4f %.4f blocks %zu ms %.2f\n",
          i, scan.cloud.size(), u->iterations, u->inlier_ratio, u->rms_m, u->degenerate_directions, u->lost, es[0],
          es[1], es[2], es[3], es[4], es[5], f.error[0], f.error[1], f.error[2], f.sigma[0], f.sigma[1], f.sigma[2],
          odometry.map_blocks(), f.cpu_ms.back());
    }
    before = truth;
  }
  print(scene.name.c_str(), f);
}

Scan kitti_scan(const std::string& file, int index, double angle_deg) {
  std::ifstream in(file, std::ios::binary);
  Scan scan;
  scan.valid = {Time{from_seconds(0.1 * index)}, Time{from_seconds(0.1 * (index + 1))}};
  scan.deskewed = true;
  float v[4];
  const float a = static_cast<float>(angle_deg * 3.14159265358979 / 180);
  while (in.read(reinterpret_cast<char*>(v), sizeof v)) {
    Eigen::Vector3f p(v[0], v[1], v[2]);
    const float h = std::hypot(p.x(), p.y());
    if (h > 0) {  // raise the elevation by a
      const float c = std::cos(a), s = std::sin(a);
      const float h2 = c * h - s * p.z(), z2 = s * h + c * p.z();
      p = {p.x() * h2 / h, p.y() * h2 / h, z2};
    }
    scan.cloud.push_back(p, v[3], 0, 0, ReturnType::kStrongest);
  }
  return scan;
}

/// Poses of the LiDAR from those of the camera; none where the folder has no truth.
std::vector<SE3> kitti_truth(const std::string& folder) {
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> m;
  const auto read = [&](std::istream& in) {
    for (int k = 0; k < 12; ++k) in >> m(k / 4, k % 4);
    return bool(in);
  };
  const auto pose = [&] { return SE3(Eigen::Matrix3d(m.leftCols<3>()), Eigen::Vector3d(m.col(3))); };
  std::ifstream poses(folder + "/poses_cam0.txt"), calib(folder + "/calib.txt");
  std::vector<SE3> truth;
  while (read(poses)) truth.push_back(pose());
  SE3 Tr;
  for (std::string word; calib >> word;)
    if (word == "Tr:" && read(calib)) Tr = pose();
  for (SE3& T : truth) T = Tr.inverse() * T * Tr;
  return truth;
}

void trace(int scan, std::size_t points, const OdometryUpdate& u, const SE3& true_step, double ms) {
  const Vector6 e = (u.T_previous_base.mean.inverse() * true_step).log();
  std::printf(
      "%d pts %zu it %d conv %d inl %.2f rms %.4f deg %d lost %d step %.4f err %.4f %.4f %.4f r %.5f %.5f %.5f ms "
      "%.2f\n",
      scan, points, u.iterations, u.converged, u.inlier_ratio, u.rms_m, u.degenerate_directions, u.lost,
      u.T_previous_base.mean.translation().norm(), e[0], e[1], e[2], e[3], e[4], e[5], ms);
}

/// Mean relative errors over steps of so many scans.
void print_relative(const std::vector<SE3>& poses, const std::vector<SE3>& truth, std::size_t gap) {
  double sum = 0, rot = 0;
  int n = 0;
  for (std::size_t i = 0; i + gap < poses.size(); ++i) {
    const SE3 step = poses[i].inverse() * poses[i + gap], true_step = truth[i].inverse() * truth[i + gap];
    const Vector6 e = (step.inverse() * true_step).log();
    sum += e.head<3>().norm() / true_step.translation().norm();
    rot += e.tail<3>().norm() / true_step.translation().norm();
    ++n;
  }
  std::printf("  gap %2zu: %.3f %% %.5f deg/m\n", gap, 100 * sum / n, rot / n * 57.3);
}

void run_kitti(const std::filesystem::path& recording, int scans, double angle_deg) {
  const std::string folder = recording.string();
  const std::vector<SE3> truth = kitti_truth(folder);
  Workers workers(1);
  LidarOdometry odometry(g_config, {}, workers);
  Figures f;
  SE3 before;
  std::vector<SE3> poses;
  for (int i = 0; i < scans; ++i) {
    char name[64];
    std::snprintf(name, sizeof name, "/velodyne/%06d.bin", i);
    const Scan scan = kitti_scan(folder + name, i, angle_deg);
    Budget budget = Budget::steps(most_steps(g_config));
    const Duration t0 = thread_cpu_time();
    const auto u = odometry.update(scan, budget);
    f.cpu_ms.push_back(to_milliseconds(thread_cpu_time() - t0));
    const SE3 t = truth.empty() ? u->T_odom_base.mean : truth[0].inverse() * truth[static_cast<std::size_t>(i)];
    account(f, *u, t, before, i == 0);
    if (std::getenv("TRACE")) trace(i, scan.cloud.size(), *u, before.inverse() * t, f.cpu_ms.back());
    before = t;
    poses.push_back(u->T_odom_base.mean);
  }
  print(recording.filename().c_str(), f);
  if (truth.empty()) return (void)std::printf("  distance %.2f\n", poses.back().translation().norm());
  for (const std::size_t gap : {1U, 5U, 10U, 15U}) print_relative(poses, truth, gap);
}

}  // namespace
}  // namespace cairn::odometry

int main(int argc, char** argv) {
  using namespace cairn;
  const std::string what = argc > 1 ? argv[1] : "all";
  const double seconds = argc > 2 ? std::atof(argv[2]) : 60;
  const unsigned seed = argc > 3 ? static_cast<unsigned>(std::atoi(argv[3])) : 1;
  config::Section section;
  odometry::declare(section, odometry::g_config);
  std::string yaml;
  for (int i = 4; i < argc; ++i) {
    std::string kv = argv[i];
    kv.replace(kv.find('='), 1, ": ");
    yaml += kv + "\n";
  }
  if (const auto ok = config::parse(yaml, "args", section); !ok)
    return std::printf("%s\n", to_string(ok.error()).c_str()), 2;
  const std::filesystem::path data = support::recorded_data("kitti");
  if (what == "kitti" || what == "all") {
    odometry::run_kitti(data / "odometry00", 16, 0.0);
    odometry::run_kitti(data / "odometry00", 16, 0.205);
  }
  if (what == "street22" || what == "all") odometry::run_kitti(data / "street22", 22, 0);
  for (const auto& scene : support::all_scenes())
    if (what == scene.name || what == "all") odometry::run_scene(scene, seconds, seed);
}
