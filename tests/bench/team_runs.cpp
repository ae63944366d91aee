// SPDX-License-Identifier: Apache-2.0
// A team on simulated recordings, in virtual time over an emulated link: who finds whom and when, how exactly, what it
// takes to send, and whether all end with one map that fits the world.
//   team_runs RECORDINGS… [key=value …]     RECORDINGS: a folder of recordings; several, with commas: all
//   their robots are one team, in this order. Between robots of different worlds every merge is wrong.
//   keys: resolution (0.1 m), loss (0.2), jitter_ms (300), rate (bytes/s, 16000), after (s of silence at the end, 30),
//   out (a folder for the team's map of each robot), looks (1: every place that was looked at, with what speaks for
//   it), submap (m of path, 300), drift (of the way, 0) and drift_deg (a metre, 0) that odd robots' odometry is given,
//   the others' with the other sign
#include <xxhash.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include "fusion/matching/evidence/acceptance.hpp"
#include "fusion/matching/evidence/judge.hpp"
#include "fusion/matching/matcher.hpp"
#include "hal/clock.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tests/bench/team/figures.hpp"
#include "tests/bench/team/recorded_robot.hpp"
#include "tests/fusion/team/fleet/network.hpp"
#include "tools/team/figures/map_overlap.hpp"

namespace cairn::bench {
namespace {

namespace fs = std::filesystem;
using peers::RobotId;

std::map<std::string, double> g_options{{"resolution", 0.1}, {"loss", 0.2}, {"jitter_ms", 300},
                                        {"rate", 16000},     {"after", 30}, {"looks", 0},
                                        {"submap", 300},     {"drift", 0},  {"drift_deg", 0}};
fs::path g_out;
constexpr Duration kTick = std::chrono::milliseconds(100);
constexpr int kStepsOfATick = 150;  // of fusing: 1.5 ms of each 40, at 25 µs a step

Vector6 log_error(const SE3& truth, const SE3& T) { return (truth.inverse() * T).log(); }

double iou(const mapping::SemanticOcTree& map, const SE3& T_world_map, const mapping::SemanticOcTree& world,
           const team_run::Area* within = nullptr) {
  return team_run::iou_with_world(map, T_world_map, world, within).value_or(0);
}

std::uint64_t hash_of(const mapping::SemanticOcTree& map) {
  std::ostringstream out;
  mapping::SemanticOcTree copy(map);
  (void)copy.writeData(out);
  return XXH3_64bits(out.str().data(), out.str().size());
}

class TeamRun {
 public:
  TeamRun(std::vector<std::unique_ptr<RecordedRobot>> robots, fs::path first)
      : robots_(std::move(robots)),
        first_(std::move(first)),
        network_(
            {g_options["loss"], 0.05, 0, std::chrono::milliseconds(20), from_seconds(g_options["jitter_ms"] / 1000)},
            1) {}

  void run() {
    Time end = Time::max();
    for (; now_ < end; now_ += kTick) {
      bool all_ended = true;
      for (auto& robot : robots_) {
        if (const auto advanced = robot->advance(now_); !advanced) std::puts(to_string(advanced.error()).c_str());
        all_ended = all_ended && robot->ended();
      }
      if (all_ended && end == Time::max()) {
        stopped_ = now_;
        end = now_ + from_seconds(g_options["after"]);
      }
      for (auto& arrived : network_.arrived(now_)) {
        RecordedRobot& robot = *robots_[arrived.to - 1];
        robot.received_bytes += arrived.bytes.size();
        if (const auto taken = robot.team.receive(arrived.bytes, now_); !taken && refused_++ == 0)
          std::printf("  %.1f s: robot_%d refuses a datagram: %s\n", to_seconds(now_), static_cast<int>(arrived.to),
                      to_string(taken.error()).c_str());
      }
      for (auto& robot : robots_) step(*robot);
      if (end == Time::max() && now_.time_since_epoch() % std::chrono::seconds(1) == Duration::zero()) note_errors();
    }
  }

  void report() {
    const auto world = mapping::load_map(first_ / "world.ot");
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      RecordedRobot& robot = *robots_[i];
      const auto& map = robot.finished_map();
      if (!g_out.empty()) (void)mapping::save_cairn(map, g_out / ("team_" + std::to_string(i + 1) + ".cairn"));
      std::printf(
          "%s robot_%zu: team of %zu, map %016llx, sent %.0f kB, received %.0f kB, raw %.1f MB (1/%.0f), "
          "slice max %.2f ms\n",
          first_.parent_path().filename().c_str(), i + 1, robot.team.poses().T_team_odom.size(),
          static_cast<unsigned long long>(hash_of(map)), static_cast<double>(sent_[i + 1].all()) / 1e3,
          static_cast<double>(robot.received_bytes) / 1e3, static_cast<double>(robot.raw_bytes()) / 1e6,
          static_cast<double>(robot.raw_bytes()) / static_cast<double>(sent_[i + 1].all()),
          to_milliseconds(longest_slice_));
      sent_[i + 1].print();
      print_items(robot.team);
      if (!world) continue;
      const auto& poses = robot.team.poses();
      const SE3 T_world_team = robots_[poses.anchor - 1]->T_world_odom() * poses.T_team_odom.at(poses.anchor).inverse();
      const auto& own = robot.robot().map();
      const team_run::Area there{own, poses.T_team_odom.at(static_cast<RobotId>(i + 1))};
      std::printf("  own map: iou %.3f, %zu occupied; team's: iou %.3f, there %.3f, %zu occupied\n",
                  iou(own, robot.T_world_odom(), **world), team_run::occupied_leaves(own),
                  iou(map, T_world_team, **world), iou(map, T_world_team, **world, &there),
                  team_run::occupied_leaves(map));
    }
    for (RobotId a = 1; a <= robots_.size(); ++a)
      for (RobotId b = 1; b <= robots_.size(); ++b)
        if (a < b || (a > b && !robots_[a - 1]->team.poses().T_team_odom.contains(b))) report_pair(a, b);
    report_ages();
    const auto& poses = robots_.front()->team.poses();
    std::printf(
        "  %zu submaps, %td of %zu claims kept; %d refinements, %.2f s each; steps %.1f s, longest %.1f ms; "
        "fusing %.1f s; inter-robot error along the run: mean %.3f m, max %.3f m; %d datagrams refused\n",
        poses.submaps.size(), std::ranges::count(poses.kept, true), poses.kept.size(), refinements_,
        to_seconds(refine_time_) / std::max(1, refinements_), to_seconds(step_time_), to_milliseconds(longest_step_),
        to_seconds(fuse_time_), error_sum_ / std::max(1, errors_), worst_, refused_);
  }

 private:
  void step(RecordedRobot& robot) {
    std::vector<peers::Outgoing> out;
    const Duration before_step = thread_cpu_time();
    robot.team.step(now_, out);
    step_time_ += thread_cpu_time() - before_step;
    longest_step_ = std::max(longest_step_, thread_cpu_time() - before_step);
    const RobotId self = robot.team.exchange().self();
    for (const auto& datagram : out)
      sent_[self].add(datagram.bytes, network_.send(self, robots_.size(), datagram, now_));
    ages_.said(robot.team, now_);
    if (auto job = robot.team.next_match(now_)) {
      const Duration before = thread_cpu_time();
      Budget budget = Budget::steps(matching::kAmpleSteps);
      cairn::team::run(*job, budget);
      (job->refinement ? refine_time_ : match_time_) += thread_cpu_time() - before;
      ++(job->refinement ? refinements_ : matches_);
      if (g_options["looks"] != 0 && !job->refinement) print_looks(self, *job);
      robot.team.matched(std::move(*job), now_);
    }
    const Duration before = thread_cpu_time();
    Budget slice = Budget::steps(kStepsOfATick);
    robot.team.fuse(slice);
    longest_slice_ = std::max(longest_slice_, thread_cpu_time() - before);
    fuse_time_ += thread_cpu_time() - before;
    ages_.fused(robot.team, now_);
    if (const auto size = robot.team.poses().T_team_odom.size(); size != team_sizes_[self]) {
      team_sizes_[self] = size;
      std::printf("  %.1f s: robot_%d is in a team of %zu\n", to_seconds(now_), static_cast<int>(self), size);
      for (RobotId peer = self + 1; peer <= robots_.size(); ++peer)
        std::printf("    about robot_%d: %s\n", static_cast<int>(peer), robot.team.standing(peer, now_).reason.c_str());
    }
  }

  [[nodiscard]] SE3 true_pose(RobotId a, RobotId b) const {
    return robots_[a - 1]->T_world_odom().inverse() * robots_[b - 1]->T_world_odom();
  }

  static void print_evidence(const matching::Evidence& e) {
    std::printf(
        " overlap %.2f pairs %d %.0f m2 floor %.0f m2 inliers %.2f conflict %.3f %.3f weakest %.3f unique %.2f score "
        "%.3f",
        e.overlap, e.structure_pairs, e.agreeing_m2, e.agreeing_floor_m2, e.structure_inliers, e.conflict,
        e.reverse_conflict, e.weakest_translation, e.uniqueness, e.score);
  }

  /// What the pair would look like at its true pose, and every place that is held.
  void print_looks(RobotId self, const team::MatchJob& job) {
    const SE3 truth = true_pose(self, job.peer);
    const mapping::SemanticOcTree own_map = job.own.map(), other_map = job.other.map();
    const auto own = matching::MapFeatures::build(own_map), other = matching::MapFeatures::build(other_map);
    if (!own || !other) return;
    const auto seen = matching::Judge(*own, *other).look(truth, matching::anywhere().covariance);
    std::printf("  %.1f s look %d-%d truth: p %.3f", to_seconds(now_), static_cast<int>(self),
                static_cast<int>(job.peer), matching::decide(seen.evidence).probability_correct);
    print_evidence(seen.evidence);
    std::puts("");
    for (const matching::Hypothesis& h : job.match->hypotheses().all()) {
      const Vector6 e = log_error(truth, h.T_a_b.mean);
      std::printf("  %.1f s look %d-%d error %.2f m %.2f deg: p %.3f agreed %d", to_seconds(now_),
                  static_cast<int>(self), static_cast<int>(job.peer), e.head<3>().norm(), e.tail<3>().norm() * 57.29578,
                  h.probability_correct, h.agreements);
      print_evidence(h.evidence);
      std::printf(" (%s)\n", h.reason.c_str());
    }
  }

  /// Of where a robot sees another: what teammates want to know of each other.
  [[nodiscard]] std::optional<SE3> error_between(RobotId a, RobotId b) const {
    const auto& poses = robots_[a - 1]->team.poses().T_team_odom;
    if (!poses.contains(a) || !poses.contains(b)) return std::nullopt;
    const auto base = [&](RobotId id) { return poses.at(id) * robots_[id - 1]->T_odom_base(); };
    const auto truth = [&](RobotId id) { return robots_[id - 1]->T_world_base(); };
    return (truth(a).inverse() * truth(b)).inverse() * (base(a).inverse() * base(b));
  }

  void note_errors() {
    for (RobotId a = 1; a <= robots_.size(); ++a)
      for (RobotId b = a + 1; b <= robots_.size(); ++b)
        if (const auto error = error_between(a, b)) {
          error_sum_ += error->translation().norm();
          worst_ = std::max(worst_, error->translation().norm());
          ++errors_;
        }
  }

  void report_ages() {
    // Robots that stop say all that they still kept back at once.
    std::printf(
        "  from said to fused: p50 %.2f s, p99 %.2f s, max %.2f s of %zu; while they drive p50 %.2f s, p99 %.2f s, max "
        "%.2f s; %d matches, %.2f s each\n",
        ages_.quantile(0.5), ages_.quantile(0.99), ages_.quantile(1), ages_.count(), ages_.quantile(0.5, stopped_),
        ages_.quantile(0.99, stopped_), ages_.quantile(1, stopped_), matches_,
        to_seconds(match_time_) / std::max(1, matches_));
  }

  void report_pair(RobotId a, RobotId b) {
    const team::Team& team = robots_[a - 1]->team;
    const auto& poses = team.poses().T_team_odom;
    if (!poses.contains(b)) {
      std::printf("  %d-%d not merged: %s\n", static_cast<int>(a), static_cast<int>(b),
                  team.standing(b, now_).reason.c_str());
      return;
    }
    const SE3 error = error_between(a, b).value_or(SE3());
    const SE3 frames = true_pose(a, b).inverse() * (poses.at(a).inverse() * poses.at(b));
    std::printf("  %d-%d error %.3f m %.3f deg (frames %.3f m %.3f deg)%s\n", static_cast<int>(a), static_cast<int>(b),
                error.translation().norm(), rotation_angle(error) * 57.29578, frames.translation().norm(),
                rotation_angle(frames) * 57.29578, error.translation().norm() > 1 ? " WRONG" : "");
  }

  std::vector<std::unique_ptr<RecordedRobot>> robots_;
  fs::path first_;  // recording
  fleet::Network network_;
  Time now_{}, stopped_{};
  Duration longest_slice_{}, match_time_{}, refine_time_{}, fuse_time_{}, step_time_{}, longest_step_{};
  int matches_ = 0, refinements_ = 0, refused_ = 0;
  double error_sum_ = 0, worst_ = 0;
  int errors_ = 0;
  std::map<RobotId, std::size_t> team_sizes_;
  std::map<RobotId, SentBytes> sent_;
  Ages ages_;
};

int run(const std::string& folders) {
  std::vector<std::unique_ptr<RecordedRobot>> robots;
  const std::vector<fs::path> recordings = recordings_of(folders);
  for (std::size_t i = 1; i <= recordings.size(); ++i) {
    team::TeamConfig config;
    config.id = static_cast<RobotId>(i);
    config.name = "robot_" + std::to_string(i);
    config.resolution_m = g_options["resolution"];
    config.exchange.bytes_per_second = static_cast<std::size_t>(g_options["rate"]);
    config.own_submaps.length_m = g_options["submap"];
    auto robot = RecordedRobot::open(recordings[i - 1], config);
    if (!robot) {
      std::puts(to_string(robot.error()).c_str());
      return 1;
    }
    const double sign = i % 2 == 1 ? 1 : -1;
    (*robot)->set_drift({sign * g_options["drift"], sign * g_options["drift_deg"] / 57.29578});
    robots.push_back(*std::move(robot));
  }
  if (robots.empty()) return 1;
  TeamRun team(std::move(robots), recordings.front());
  team.run();
  team.report();
  return 0;
}

}  // namespace
}  // namespace cairn::bench

int main(int argc, char** argv) {
  std::vector<std::string> folders;
  for (int i = 1; i < argc; ++i) {
    const char* equals = std::strchr(argv[i], '=');
    if (std::strncmp(argv[i], "out=", 4) == 0)
      cairn::bench::g_out = argv[i] + 4;
    else if (equals != nullptr)
      cairn::bench::g_options[std::string(argv[i], static_cast<std::size_t>(equals - argv[i]))] = std::atof(equals + 1);
    else
      folders.emplace_back(argv[i]);
  }
  int failed = folders.empty() ? 2 : 0;
  for (const std::string& folder : folders) failed |= cairn::bench::run(folder);
  return failed;
}
