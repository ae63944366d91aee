// SPDX-License-Identifier: Apache-2.0
// Maps of unlike robots: how often a LiDAR's and a stereo camera's map are matched, and how well.
//   matching_unlike STARTS MAP… [csv]
// A MAP is KIND:SCENE:RUN:RECORDING, with KIND a (LiDAR) or b (stereo or depth camera). RUN is a folder that `cairn
// run` left, RECORDING the simulated recording with its ground truth. Each b is matched with each a of its scene,
// without a guess and from the first STARTS of the protocol's 125 starts. It is matched with the mirror image of each
// a, and with each a of other scenes, without a guess and from a tenth of the starts: every answer is wrong there.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "fusion/matching/default_matcher.hpp"
#include "fusion/matching/evidence/judge.hpp"
#include "fusion/matching/methods.hpp"
#include "hal/clock.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tools/protocol/methods/starts.hpp"

namespace cairn::matching {
namespace {

namespace fs = std::filesystem;

struct Chart {
  std::string name, scene;
  bool lidar = false;
  std::unique_ptr<mapping::SemanticOcTree> map, mirrored;
  std::optional<MapFeatures> features, mirrored_features;
  SE3 T_world_odom;
};

/// Answers to one kind of question.
struct Row {
  int n = 0, right = 0, accepted = 0, wrongly = 0, close = 0;
  double seconds = 0;
  std::vector<double> off_m, off_deg;
};

[[noreturn]] void fail(const std::string& why) {
  std::fprintf(stderr, "matching_unlike: %s\n", why.c_str());
  std::exit(1);
}

/// Where odometry's frame lies in the world on the whole: the mean over the way.
SE3 world_odom(const fs::path& run, const fs::path& recording) {
  const auto found = recording::read_tum(run / "trajectory.tum"),
             truth = recording::read_tum(recording / "ground_truth.tum");
  if (!found || !truth) fail(to_string(!found ? found.error() : truth.error()));
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
  Eigen::Vector3d in_odom = Eigen::Vector3d::Zero(), in_world = in_odom;
  for (const recording::StampedPose& p : *found) {
    auto next = std::ranges::lower_bound(*truth, p.stamp, {}, &recording::StampedPose::stamp);
    if (next == truth->end()) --next;
    turns += (next->pose * p.pose.inverse()).rotation();
    in_odom += p.pose.translation() / static_cast<double>(found->size());
    in_world += next->pose.translation() / static_cast<double>(found->size());
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(turns, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
  return {R, in_world - R * in_odom};
}

std::unique_ptr<mapping::SemanticOcTree> mirror_of(const mapping::SemanticOcTree& map) {
  auto out = std::make_unique<mapping::SemanticOcTree>(map.getResolution());
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    const int edge = 1 << (mapping::SemanticOcTree::kDepth - leaf.getDepth());
    octomap::OcTreeKey first = leaf.getIndexKey();
    for (int x = 0; x < edge; ++x)
      for (int y = 0; y < edge; ++y)
        for (int z = 0; z < edge; ++z) {
          const auto at = [](int k) { return static_cast<octomap::key_type>(k); };
          out->setNodeValue(
              octomap::OcTreeKey(at(first[0] + x), at(2 * kKeyOrigin - 1 - first[1] - y), at(first[2] + z)),
              leaf->getLogOdds(), true);
        }
  }
  out->canonicalise();
  return out;
}

Chart load(const std::string& text) {
  std::istringstream in(text);
  std::string kind, run, recording;
  Chart c;
  if (!std::getline(in, kind, ':') || !std::getline(in, c.scene, ':') || !std::getline(in, run, ':') ||
      !std::getline(in, recording))
    fail("not KIND:SCENE:RUN:RECORDING: " + text);
  c.name = fs::path(run).filename();
  c.lidar = kind == "a";
  auto map = mapping::load_map(fs::path(run) / "map.cairn");
  if (!map) fail(to_string(map.error()));
  c.map = *std::move(map);
  c.features = *MapFeatures::build(*c.map);
  if (c.lidar) c.mirrored = mirror_of(*c.map);
  if (c.lidar) c.mirrored_features = *MapFeatures::build(*c.mirrored);
  c.T_world_odom = world_odom(run, recording);
  return c;
}

class Bench {
 public:
  Bench(int starts, bool csv) : starts_(starts), csv_(csv) {
    if (csv)
      std::puts(
          "type,a,b,true_overlap,off_m,off_deg,accepted,p,overlap,inliers,structure_inliers,m2,floor_m2,conflict,"
          "reverse,weakest,uniqueness,score,s,reason");
  }

  void same_scene(const Chart& a, const Chart& b) {
    const SE3 truth = a.T_world_odom.inverse() * b.T_world_odom;
    const auto matcher = *make_matcher("default", *a.features, *b.features);
    const Judge judge(*a.features, *b.features);
    about_ = {a.name, b.name, judge.look(truth, anywhere().covariance).evidence.overlap};
    if (csv_) {
      Budget budget = Budget::steps(kAmpleSteps);
      const Look look = DefaultMatcher(*a.features, *b.features).look_again(truth, budget);
      MatchResult r;
      r.T_a_b = look.T_a_b, r.evidence = look.evidence, r.overlap = look.evidence.overlap;
      print("truth", r, truth, 0);
    }
    ask("global", *matcher, std::nullopt, &truth);
    for (const int i : protocol::chosen_starts(starts_)) {
      const SE3 from = protocol::start_pose(truth, protocol::starts()[static_cast<std::size_t>(i)]);
      ask("local", *matcher, UncertainPose{from, default_prior_covariance()}, &truth);
    }
    other("mirrored", a, *a.mirrored_features, b);
  }

  void other(const char* type, const Chart& a, const MapFeatures& of_a, const Chart& b) {
    const auto matcher = *make_matcher("default", of_a, *b.features);
    about_ = {a.name, b.name, 0};
    ask(type, *matcher, std::nullopt, nullptr);
    for (const int i : protocol::chosen_starts(starts_ / 10)) {
      const SE3 from = protocol::start_pose(SE3(), protocol::starts()[static_cast<std::size_t>(i)]);
      ask(std::string(type) + ", guess", *matcher, UncertainPose{from, default_prior_covariance()}, nullptr);
    }
  }

  void print() const {
    for (const auto& [name, row] : rows_) {
      const auto median = [](std::vector<double> v) {
        std::ranges::sort(v);
        return v.empty() ? 0 : v[v.size() / 2];
      };
      std::printf(
          "%-34s %5d  right %5d (%5.1f %%), within 0.10 m and 1 deg %5d; accepted %5d, wrongly %3d; median %.3f m %.2f "
          "deg; %.2f s\n",
          name.c_str(), row.n, row.right, 100.0 * row.right / row.n, row.close, row.accepted, row.wrongly,
          median(row.off_m), median(row.off_deg), row.seconds / row.n);
    }
  }

 private:
  struct About {
    std::string a, b;
    double overlap = 0;
  };

  void ask(const std::string& type, const Matcher& matcher, const std::optional<UncertainPose>& guess,
           const SE3* truth) {
    Budget budget = Budget::steps(kAmpleSteps);
    const Duration start = thread_cpu_time();
    const MatchResult r = *matcher.match(guess, budget);
    const double seconds = to_seconds(thread_cpu_time() - start);
    const auto off = protocol::error_of(r.T_a_b.mean, truth == nullptr ? SE3() : *truth);
    const bool right = truth != nullptr && off.success();
    std::string name = type;
    if (truth != nullptr) name += about_.overlap >= 0.4 ? ", overlap of 40 % and more" : ", overlap below 40 %";
    Row& row = row_of(name);
    ++row.n;
    row.right += right;
    row.accepted += r.accepted;
    row.wrongly += r.accepted && !right;
    row.close += right && off.m <= 0.1 && off.deg <= 1;
    row.seconds += seconds;
    if (right) row.off_m.push_back(off.m), row.off_deg.push_back(off.deg);
    if (csv_) print(type, r, truth == nullptr ? SE3() : *truth, seconds);
    if (r.accepted && !right)
      std::printf("# WRONG %s %s %s: %s\n", type.c_str(), about_.a.c_str(), about_.b.c_str(), r.reason.c_str());
  }

  void print(const std::string& type, const MatchResult& r, const SE3& truth, double seconds) const {
    const auto off = protocol::error_of(r.T_a_b.mean, truth);
    const Evidence& e = r.evidence;
    std::printf("%s,%s,%s,%.3f,%.3f,%.2f,%d,%.4f,%.3f,%.3f,%.3f,%.1f,%.1f,%.4f,%.4f,%.4f,%.3f,%.4f,%.2f,%s\n",
                type.c_str(), about_.a.c_str(), about_.b.c_str(), about_.overlap, off.m, off.deg, r.accepted,
                r.probability_correct, r.overlap, e.inlier_ratio, e.structure_inliers, e.agreeing_m2,
                e.agreeing_floor_m2, e.conflict, e.reverse_conflict, e.weakest_translation, e.uniqueness, e.score,
                seconds, r.reason.c_str());
    std::fflush(stdout);
  }

  Row& row_of(const std::string& name) {
    const auto found = std::ranges::find(rows_, name, &std::pair<std::string, Row>::first);
    return found != rows_.end() ? found->second : rows_.emplace_back(name, Row{}).second;
  }

  int starts_;
  bool csv_;
  About about_;
  std::vector<std::pair<std::string, Row>> rows_;
};

void run(int starts, const std::vector<std::string>& maps, bool csv) {
  std::vector<Chart> charts;
  for (const std::string& text : maps) charts.push_back(load(text));
  Bench bench(starts, csv);
  for (const Chart& a : charts)
    for (const Chart& b : charts) {
      if (!a.lidar || b.lidar) continue;
      if (a.scene == b.scene) bench.same_scene(a, b);
      if (a.scene != b.scene) bench.other("other scene", a, *a.features, b);
    }
  bench.print();
}

}  // namespace
}  // namespace cairn::matching

int main(int argc, char** argv) {
  std::vector<std::string> maps(argv + std::min(argc, 2), argv + argc);
  const bool csv = !maps.empty() && maps.back() == "csv";
  if (csv) maps.pop_back();
  cairn::matching::run(argc > 1 ? std::atoi(argv[1]) : 0, maps, csv);
}
