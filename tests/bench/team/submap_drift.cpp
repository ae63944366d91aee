// SPDX-License-Identifier: Apache-2.0
// How sure a robot's submaps are of each other, on recordings with truth:
//   submap_drift [length=25] [drift_percent=1] [drift_deg_per_m=0.02] RECORDING…
// For each recording two lines: with the profile's drift alone, and with odometry's own covariance above it. Each says
// how many submaps there are, the medians of their standard deviations (along the way, and of the heading), the mean
// NEES of their motions (6 is right, less is cautious), and how many are beyond the 99 % bound of chi-squared.
// The last run's files stay in ./submap_drift-out.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "fusion/peers/items/claim.hpp"
#include "fusion/peers/own_submaps.hpp"
#include "onboard/app/run.hpp"
#include "onboard/report/figures/trajectory_error.hpp"

namespace cairn {
namespace {

constexpr double kBound = 16.81;  // 99 % of chi-squared with 6 degrees of freedom
constexpr Duration kBatch = std::chrono::milliseconds(500);

struct Motion {
  double sigma_m = 0, sigma_rad = 0, nees = 0;
};

struct Located {
  UncertainPose T_odom_base;
  SE3 T_truth_base;
};

std::vector<Located> located(const report::RunReport& report) {
  std::vector<report::StampedPose> estimate;
  for (const auto& p : report.trajectory) estimate.push_back({p.stamp, p.T_odom_base.mean});
  std::vector<Located> all;
  Time next = Time::min();
  for (const auto& m : report::match_by_time(estimate, report.ground_truth, std::chrono::milliseconds(200))) {
    if (m.stamp < next) continue;
    next = m.stamp + kBatch;
    const auto p = std::ranges::find(report.trajectory, m.stamp, &report::PoseEstimate::stamp);
    all.push_back({p->T_odom_base, m.truth});
  }
  return all;
}

std::vector<Motion> motions(const std::vector<Located>& way, const peers::OwnSubmapsConfig& config, bool own) {
  peers::Exchange exchange(1, "a", peers::Epoch{1} << 32U);
  peers::OwnSubmaps submaps(config, 1.6);
  std::vector<Motion> all;
  SE3 T_odom_last, T_truth_last = way.front().T_truth_base * way.front().T_odom_base.mean.inverse();
  for (const Located& at : way) {
    const auto before = submaps.current();
    submaps.be_at({at.T_odom_base.mean, own ? at.T_odom_base.covariance : Matrix6(Matrix6::Zero())}, exchange);
    if (submaps.current() == before) continue;
    const auto& item = exchange.layers().at(1).holding.items().at(peers::ItemId::submap(submaps.current()));
    const UncertainPose T = peers::decode_submap(item.payload)->T_odom_submap;
    const SE3 T_truth = at.T_truth_base * at.T_odom_base.mean.inverse() * T.mean;
    const Vector6 e = ((T_odom_last.inverse() * T.mean).inverse() * (T_truth_last.inverse() * T_truth)).log();
    all.push_back({std::sqrt(T.covariance.topLeftCorner<2, 2>().trace() / 2), std::sqrt(T.covariance(5, 5)),
                   e.dot(T.covariance.llt().solve(e))});
    T_odom_last = T.mean;
    T_truth_last = T_truth;
  }
  return all;
}

double median(std::vector<Motion> motions, double Motion::*value) {
  std::ranges::sort(motions, {}, value);
  return motions.empty() ? 0 : motions[motions.size() / 2].*value;
}

void say(const char* what, const std::vector<Motion>& motions) {
  double nees = 0, most_m = 0;
  for (const Motion& m : motions)
    nees += m.nees / static_cast<double>(motions.size()), most_m = std::max(most_m, m.sigma_m);
  const auto beyond = std::ranges::count_if(motions, [](const Motion& m) { return m.nees > kBound; });
  std::printf("  %-8s %3zu submaps, sigma %.2f m (most %.2f m), %.2f deg; NEES %.2f, beyond 99 %%: %td\n", what,
              motions.size(), median(motions, &Motion::sigma_m), most_m,
              median(motions, &Motion::sigma_rad) * 180 / M_PI, nees, beyond);
}

}  // namespace
}  // namespace cairn

int main(int argc, char** argv) {
  using namespace cairn;
  peers::OwnSubmapsConfig config{.length_m = 25};
  for (int i = 1; i < argc; ++i) {
    const char* const value = std::strchr(argv[i], '=');
    const std::string key = value != nullptr ? std::string(static_cast<const char*>(argv[i]), value) : std::string();
    if (key == "length") config.length_m = std::atof(value + 1);
    if (key == "drift_percent") config.drift_m_per_m = std::atof(value + 1) / 100;
    if (key == "drift_deg_per_m") config.drift_rad_per_m = std::atof(value + 1) * M_PI / 180;
    if (value != nullptr) continue;
    app::RunOptions options;
    options.recording = argv[i];
    options.out = "submap_drift-out";
    options.pace = app::Pace::kMaximum;
    options.networks = app::NetworkUse::kOff;
    const auto result = app::run(options);
    if (!result) return std::fprintf(stderr, "%s\n", to_string(result.error()).c_str()), 1;
    const auto way = located((*result)->report);
    std::printf("%s: %zu poses\n", argv[i], way.size());
    if (way.empty()) continue;
    say("profile", motions(way, config, false));
    say("own", motions(way, config, true));
  }
}
