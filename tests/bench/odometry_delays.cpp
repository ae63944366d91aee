// SPDX-License-Identifier: Apache-2.0
// Odometry on packets that come late, in bursts, twice, in another order, or not at all:
//   odometry_delays [patterns=N] [first=SEED] [seconds=S] RECORDING…
// Each pattern delays the packets of one recording. Its trajectory is compared with that of the undisturbed packets, at
// the stamps that its own scans have, after the best rigid alignment. Prints the patterns that leave 2 cm, and whether
// an event says why. Exit 1: some pattern leaves 2 cm without an event.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "drivers/recording/recording_reader.hpp"
#include "drivers/velodyne/lidar.hpp"
#include "onboard/odometry/odometry.hpp"

namespace cairn::odometry {
namespace {

using namespace std::chrono_literals;

constexpr double kApart_m = 0.02;
constexpr Duration kSettles = 8s;  // after the first packets came late, stamps are right so much later

struct Packets {
  SE3 T_base_lidar;
  std::vector<Packet> packets;
};

Packets load(const std::filesystem::path& folder, Duration length) {
  auto reader = recording::RecordingReader::open(folder).value();
  Packets drive{reader->recording().sources.front().T_base_sensor(), {}};
  Packet packet;
  while (true) {
    const auto poll = reader->next(packet, Duration::zero());
    if (!poll || *poll == Poll::kEnd) break;
    if (packet.source != SourceId{0}) continue;
    if (!drive.packets.empty() && packet.arrival - drive.packets.front().arrival > length) break;
    drive.packets.push_back(packet);
  }
  return drive;
}

/// Stalls whose packets come later or never, late starts, repeated and overtaken packets.
std::vector<Packet> disturbed(const std::vector<Packet>& packets, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto upto = [&](double most) { return std::uniform_real_distribution<double>(0, most)(random); };
  std::vector<Packet> out;
  Time held_until = packets.front().arrival + (upto(1) < 0.5 ? from_seconds(upto(1.0)) : Duration{});
  bool drops = false;
  Time last = Time::min();
  for (const Packet& packet : packets) {
    if (upto(1) < 5e-4) {
      held_until = packet.arrival + from_seconds(std::pow(10.0, -3 + upto(3.3)));
      drops = upto(1) < 0.3;
    }
    if (drops && packet.arrival < held_until && upto(1) < 0.5) continue;
    out.push_back(packet);
    last = std::max({last + 1us, held_until, packet.arrival + from_seconds(upto(1e-4))});
    out.back().arrival = last;
    if (out.size() > 1 && upto(1) < 0.01) std::swap(out.back().bytes, out[out.size() - 2].bytes);
    if (upto(1) < 0.01) out.push_back(out.back()), last += 1us, out.back().arrival = last;
  }
  return out;
}

struct Followed {
  std::vector<OdometryUpdate> scans;
  std::vector<Event> events;
  std::uint64_t lost_packets = 0;
};

void follow(const Scan& scan, LidarOdometry& odometry, Monitor& monitor, Followed& out) {
  if (out.scans.empty() && scan.incomplete) return;  // a robot leaves it out, too
  Budget budget = Budget::steps(most_steps({}));
  const auto update = odometry.update(scan, budget);
  if (!update) return monitor.event(scan.valid.end, "odometry", to_string(update.error()));
  if (update->lost) monitor.event(update->stamp, "odometry", "lost");
  out.scans.push_back(*update);
}

Followed follow(const Packets& drive, const std::vector<Packet>& packets) {
  Monitor monitor;
  const auto lidar = velodyne::Lidar::create({}, SourceId{}, monitor).value();
  Workers workers(1);
  LidarOdometry odometry({}, drive.T_base_lidar, workers);
  Followed out;
  for (const Packet& packet : packets) {
    if (const Scan* scan = lidar->expire(packet.arrival)) follow(*scan, odometry, monitor, out);
    const auto scan = lidar->decode(packet);
    if (scan && *scan != nullptr) follow(**scan, odometry, monitor, out);
  }
  out.events = monitor.events();
  out.lost_packets = lidar->counters().lost_packets;
  return out;
}

/// The pose at an instant between two scans, by the motion from one to the next.
std::optional<SE3> pose_at(const Followed& track, Time t) {
  const auto after = std::ranges::lower_bound(track.scans, t, {}, [](const auto& s) { return s.stamp; });
  if (after == track.scans.end() || after == track.scans.begin()) return std::nullopt;
  const auto& before = *(after - 1);
  const double share = to_seconds(t - before.stamp) / to_seconds(after->stamp - before.stamp);
  const SE3 &a = before.T_odom_base.mean, &b = after->T_odom_base.mean;
  return a * SE3::exp(share * (a.inverse() * b).log());
}

struct Deviation {
  double worst_m = 0;
  std::size_t compared = 0;
};

/// After the best rigid alignment: where each of the two begins is chance.
Deviation deviation(const Followed& usual, const Followed& late, Time from) {
  std::vector<Eigen::Vector3d> expected, found;
  for (const OdometryUpdate& scan : late.scans) {
    const auto pose = scan.stamp < from ? std::nullopt : pose_at(usual, scan.stamp);
    if (!pose) continue;
    expected.push_back(pose->translation());
    found.push_back(scan.T_odom_base.mean.translation());
  }
  if (expected.size() < 10) return {};
  const auto n = static_cast<Eigen::Index>(expected.size());
  const Eigen::Map<const Eigen::Matrix3Xd> to(expected.front().data(), 3, n), at(found.front().data(), 3, n);
  const Eigen::Matrix4d T = Eigen::umeyama(at, to, false);
  const Eigen::Matrix3Xd error = ((T.topLeftCorner<3, 3>() * at).colwise() + T.topRightCorner<3, 1>()) - to;
  return {.worst_m = error.colwise().norm().maxCoeff(), .compared = expected.size()};
}

struct Sums {
  int patterns = 0, near = 0, said = 0, silent = 0;
  double worst_near_m = 0;
};

void try_pattern(const Packets& drive, const Followed& usual, std::uint64_t seed, Sums& sums) {
  const std::vector<Packet> packets = disturbed(drive.packets, seed);
  const Followed late = follow(drive, packets);
  const Deviation off = deviation(usual, late, drive.packets.front().arrival + kSettles);
  ++sums.patterns;
  if (off.compared > 0 && off.worst_m <= kApart_m) {
    ++sums.near;
    sums.worst_near_m = std::max(sums.worst_near_m, off.worst_m);
    return;
  }
  ++(late.events.empty() ? sums.silent : sums.said);
  std::printf("  seed %llu: %.3f m apart in %zu scans:", static_cast<unsigned long long>(seed), off.worst_m,
              off.compared);
  for (const Event& event : late.events)
    std::printf(" [%s: %s ×%llu]", event.stage.c_str(), event.what.c_str(),
                static_cast<unsigned long long>(event.count));
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace
}  // namespace cairn::odometry

int main(int argc, char** argv) {
  using namespace cairn;
  using namespace cairn::odometry;
  std::uint64_t patterns = 20, first = 0;
  double length_s = 25;
  std::vector<std::string> recordings;
  for (const std::string word : std::span(argv + 1, static_cast<std::size_t>(argc - 1))) {
    const auto equal = word.find('=');
    if (equal == std::string::npos) {
      recordings.push_back(word);
      continue;
    }
    const std::string key = word.substr(0, equal), value = word.substr(equal + 1);
    if (key == "patterns") patterns = std::stoul(value);
    if (key == "first") first = std::stoul(value);
    if (key == "seconds") length_s = std::stod(value);
  }
  Sums sums;
  for (const std::string& folder : recordings) {
    const Packets drive = load(folder, from_seconds(length_s));
    const Followed usual = follow(drive, drive.packets);
    for (std::uint64_t seed = first; seed < first + patterns; ++seed) try_pattern(drive, usual, seed, sums);
  }
  std::printf("%d patterns: %d within 2 cm (worst %.4f m), %d farther with an event, %d farther without\n",
              sums.patterns, sums.near, sums.worst_near_m, sums.said, sums.silent);
  return sums.silent > 0 ? 1 : 0;
}
