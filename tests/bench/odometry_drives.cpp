// SPDX-License-Identifier: Apache-2.0
// Odometry on recordings with truth, beside a plain ICP that gets the same scans:
//   odometry_drives [option=value …] RECORDING…
// every=N       uses every N-th scan only, as key frames come
// deskewed=1    deskews the scans with the truth and takes away their firing times
// starts=N      begins at N scans of each recording and goes on for 10 s; says how far off it is then
// first=N       begins at scan N of each recording
// A recording without ground_truth.tum is taken to stand.
// gap=S         leaves out S seconds of scans, at 8 s and then every 12 s
// wheels=0      without the wheels, where the recording has them
// icp=0         without the plain ICP, which takes most of the time
// trace=1       a line for each scan
// KEY=VALUE     any key of the configuration's section `odometry`
#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "hal/clock.hpp"
#include "onboard/odometry/odometry.hpp"
#include "tests/bench/plain_icp.hpp"
#include "tests/bench/recorded_drive.hpp"

namespace cairn::odometry {
namespace {

struct Settings {
  OdometryConfig odometry;
  bench::Thinning thinning;
  int starts = 0, first = 0;
  bool icp = true, trace = false;
};

/// Root mean square distance after the best rigid alignment.
double ate(const std::vector<SE3>& poses, const std::vector<SE3>& truth) {
  const auto n = static_cast<Eigen::Index>(poses.size());
  Eigen::Matrix3Xd ours(3, n), theirs(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    ours.col(i) = poses[static_cast<std::size_t>(i)].translation();
    theirs.col(i) = truth[static_cast<std::size_t>(i)].translation();
  }
  const Eigen::Matrix4d T = Eigen::umeyama(ours, theirs, false);
  const Eigen::Matrix3Xd moved = (T.topLeftCorner<3, 3>() * ours).colwise() + T.topRightCorner<3, 1>();
  return std::sqrt((moved - theirs).squaredNorm() / static_cast<double>(n));
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

// More would skew a scan by 3 cm or 0.6°. Chosen by hand.
constexpr double kWrongTwist_m_s = 0.3, kWrongTwist_rad_s = 0.1;

struct Figures {
  double way_m = 0, ate_m = 0, icp_m = 0, worst_m = 0, end_m = 0, end_deg = 0, nees = 0;
  int n = 0, lost = 0, longest = 0, reinitialised = 0;
  Eigen::Vector3d inside = Eigen::Vector3d::Zero();
  Vector6 twist_off = Vector6::Zero();  // mean over the last second: true motion per second - twist
  std::vector<double> ms, lost_ms;
  [[nodiscard]] bool twist_wrong() const {
    return twist_off.head<3>().norm() > kWrongTwist_m_s || twist_off.tail<3>().norm() > kWrongTwist_rad_s;
  }
};

void trace(std::size_t i, const OdometryUpdate& u, const SE3& true_step, const SE3& truth, double ms) {
  const Vector6 e = (u.T_previous_base.mean.inverse() * true_step).log(), s = true_step.log();
  const Vector6 total = (u.T_odom_base.mean.inverse() * truth).log();
  std::printf(
      "%zu twist %.2f %.2f %.1f it %d inl %.2f rms %.3f deg %d lost %d re %d | true x %.2f y %.2f yaw %.1f | err x "
      "%.3f y %.3f z %.3f r %.2f p "
      "%.2f yaw %.2f | total %.3f %.3f %.3f yaw %.2f | %.1f ms\n",
      i, u.twist[0], u.twist[1], 57.3 * u.twist[5], u.iterations, u.inlier_ratio, u.rms_m, u.degenerate_directions,
      u.lost, u.reinitialised, s[0], s[1], 57.3 * s[5], e[0], e[1], e[2], 57.3 * e[3], 57.3 * e[4], 57.3 * e[5],
      total[0], total[1], total[2], 57.3 * total[5], ms);
}

/// One scan more: the motion since the one before, and where the robot is by then.
void account(Figures& f, const OdometryUpdate& u, const SE3& true_step, const SE3& truth, double dt_s) {
  f.way_m += true_step.translation().norm();
  f.twist_off += 0.1 * (true_step.log() / dt_s - u.twist - f.twist_off);
  const Vector6 e = (u.T_odom_base.mean.inverse() * truth).log();
  f.nees += e.dot(u.T_odom_base.covariance.ldlt().solve(e)) / 6;
  for (int k = 0; k < 3; ++k) f.inside[k] += std::abs(e[k]) < 3 * std::sqrt(u.T_odom_base.covariance(k, k));
  f.end_m = (u.T_odom_base.mean.translation() - truth.translation()).norm();
  f.end_deg = 57.3 * e.tail<3>().norm();
  f.worst_m = std::max(f.worst_m, f.end_m);
}

Figures follow(const bench::RecordedDrive& drive, const Settings& settings, std::size_t first, std::size_t count) {
  Workers workers(1);
  LidarOdometry odometry(settings.odometry, drive.T_base_lidar, workers);
  bench::PlainIcp icp;
  Figures f;
  std::vector<SE3> ours, peers, truths;
  int streak = 0;
  for (std::size_t i = first; i < std::min(first + count, drive.scans.size()); ++i) {
    Budget budget = Budget::steps(most_steps(settings.odometry));
    const Duration begun = thread_cpu_time();
    const auto u = odometry.update(drive.scans[i], budget, drive.wheels[i] ? &*drive.wheels[i] : nullptr);
    const double ms = to_milliseconds(thread_cpu_time() - begun);
    if (!u) {
      std::printf("scan %zu: %s\n", i, to_string(u.error()).c_str());
      continue;
    }
    const SE3 truth = drive.truth[first].inverse() * drive.truth[i];
    if (settings.icp) peers.push_back(icp.update(drive.scans[i]));
    f.ms.push_back(ms);
    ours.push_back(u->T_odom_base.mean);
    truths.push_back(truth);
    ++f.n;
    streak = u->lost ? streak + 1 : 0;
    f.lost += u->lost ? 1 : 0;
    f.reinitialised += u->reinitialised ? 1 : 0;
    if (u->lost) f.lost_ms.push_back(ms);
    f.longest = std::max(f.longest, streak);
    if (i == first) continue;
    const SE3 step = drive.truth[i - 1].inverse() * drive.truth[i];
    if (settings.trace) trace(i, *u, step, truth, ms);
    account(f, *u, step, truth, to_seconds(drive.scans[i].valid.end - drive.scans[i - 1].valid.end));
  }
  f.ate_m = ate(ours, truths);
  if (!settings.icp) return f;
  for (SE3& T : peers) T = drive.T_base_lidar * T * drive.T_base_lidar.inverse();
  f.icp_m = ate(peers, truths);
  return f;
}

void print(const std::string& name, const Figures& f) {
  const auto share = [&](double x) { return 100 * x / std::max(1, f.n - 1); };
  std::printf(
      "%-34s %4d scans %6.1f m | ATE %.3f m %.2f %% icp %.3f m | worst %.2f end %.3f m %.2f deg | lost %d longest %d "
      "re %d | "
      "NEES/6 %.2f in3s %.0f %.0f %.0f | ms p50 %.1f p99 %.1f max %.1f lost p99 %.1f\n",
      name.c_str(), f.n, f.way_m, f.ate_m, 100 * f.ate_m / std::max(f.way_m, 1.0), f.icp_m, f.worst_m, f.end_m,
      f.end_deg, f.lost, f.longest, f.reinitialised, f.nees / std::max(1, f.n - 1), share(f.inside[0]),
      share(f.inside[1]), share(f.inside[2]), quantile(f.ms, 0.5), quantile(f.ms, 0.99), quantile(f.ms, 1.0),
      quantile(f.lost_ms, 0.99));
  std::fflush(stdout);
}

void begin_often(const bench::RecordedDrive& drive, Settings settings) {
  constexpr std::size_t kTenSeconds = 100;
  settings.icp = false;
  double worst = 0;
  int off = 0, lost = 0, twisted = 0;
  const std::size_t last = drive.scans.size() > kTenSeconds ? drive.scans.size() - kTenSeconds : 0;
  for (int k = 0; k < settings.starts; ++k) {
    const std::size_t first =
        12 + (last - 12) * static_cast<std::size_t>(k) / static_cast<std::size_t>(settings.starts);
    const Figures f = follow(drive, settings, first, kTenSeconds);
    if (f.end_m > 0.5 || f.twist_wrong())
      std::printf("  begun at scan %zu: %.2f m %.1f deg, twist %.2f m/s %.2f rad/s off, lost %d\n", first, f.end_m,
                  f.end_deg, f.twist_off.head<3>().norm(), f.twist_off.tail<3>().norm(), f.lost);
    twisted += f.twist_wrong() ? 1 : 0;
    off += f.end_m > 0.5 ? 1 : 0;
    lost += f.lost;
    worst = std::max(worst, f.end_m);
  }
  std::printf(
      "%-34s %d starts: %d off by more than 0.5 m after 10 s, worst %.3f m, %d with a wrong twist, lost %d scans\n",
      drive.name.c_str(), settings.starts, off, worst, twisted, lost);
  std::fflush(stdout);
}

bool set(Settings& s, const std::string& key, const std::string& value, std::string& yaml) {
  const int number = std::atoi(value.c_str());
  if (key == "every")
    s.thinning.every = number;
  else if (key == "starts")
    s.starts = number;
  else if (key == "first")
    s.first = number;
  else if (key == "gap")
    s.thinning.gap_s = std::atof(value.c_str());
  else if (key == "deskewed")
    s.thinning.deskewed = number != 0;
  else if (key == "wheels")
    s.thinning.wheels = number != 0;
  else if (key == "icp")
    s.icp = number != 0;
  else if (key == "trace")
    s.trace = number != 0;
  else
    yaml += key + ": " + value + "\n";
  return true;
}

}  // namespace
}  // namespace cairn::odometry

int main(int argc, char** argv) {
  using namespace cairn;
  using namespace cairn::odometry;
  Settings settings;
  std::string yaml;
  std::vector<std::string> recordings;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto equal = word.find('=');
    if (equal == std::string::npos)
      recordings.push_back(word);
    else
      set(settings, word.substr(0, equal), word.substr(equal + 1), yaml);
  }
  config::Section section;
  declare(section, settings.odometry);
  if (const auto ok = config::parse(yaml, "arguments", section); !ok)
    return std::printf("%s\n", to_string(ok.error()).c_str()), 2;
  int scans = 0, lost = 0;
  double way = 0, squared = 0;
  std::vector<double> ms;
  for (const std::string& folder : recordings) {
    const bench::RecordedDrive drive = bench::load(folder, settings.thinning);
    if (settings.starts > 0) {
      begin_often(drive, settings);
      continue;
    }
    const Figures f = follow(drive, settings, static_cast<std::size_t>(settings.first), drive.scans.size());
    print(drive.name, f);
    scans += f.n;
    lost += f.lost;
    way += f.way_m;
    squared += f.ate_m * f.ate_m;
    ms.insert(ms.end(), f.ms.begin(), f.ms.end());
  }
  if (settings.starts == 0)
    std::printf("all: %d scans, %.0f m, lost %d (%.2f %%), rms ATE %.3f m, p99 %.1f ms\n", scans, way, lost,
                100.0 * lost / std::max(1, scans),
                std::sqrt(squared / std::max(1.0, static_cast<double>(recordings.size()))), quantile(ms, 0.99));
}
