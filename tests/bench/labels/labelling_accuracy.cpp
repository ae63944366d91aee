// SPDX-License-Identifier: Apache-2.0
// How many labels are right that true pictures give to true points: what projection, occlusion and borders cost.
//   cairn simulate --scene street --seconds 20 --seed 70001 --sensors all --out sim
//   labelling_accuracy sim/robot_1 [every=5]
// Poses, points and label pictures are the simulator's; each row is another setting of the labeller. A label is wrong
// if the LiDAR's ray met a thing of another class.
#include <cstdio>
#include <cstring>
#include <deque>
#include <map>
#include <string>

#include "hal/files/file.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/perception/labelling/point_labeller.hpp"
#include "onboard/perception/networks/recorded/label_picture.hpp"
#include "tests/bench/recorded_drive.hpp"

namespace {

using namespace cairn;
namespace fs = std::filesystem;

/// The deskewed points of a sweep in base_link, and what each of them is.
struct TrueScan {
  labelling::PlacedScan placed;
  std::vector<std::uint8_t> classes;
};

/// Puts the classes of a data packet where the sensor tells how bright a return is.
void hide_classes(std::vector<std::byte>& packet, std::span<const std::byte> classes) {
  for (std::size_t i = 0; i < classes.size(); ++i)
    packet[i / velodyne::kBlockChannels * velodyne::kBlockBytes + velodyne::kBlockReturnsOffset +
           i % velodyne::kBlockChannels * velodyne::kReturnBytes + 2] = classes[i];
}

std::vector<TrueScan> true_scans(const fs::path& folder, const SE3& T_base_lidar, const bench::Truth& truth) {
  constexpr std::size_t kReturns = velodyne::kBlocks * velodyne::kBlockChannels;
  const auto labels = read_file(folder / "lidar_labels.bin", std::uint64_t{1} << 30U).value();
  auto reader = recording::RecordingReader::open(folder).value();
  Monitor monitor;
  const auto lidar = velodyne::Lidar::create({}, SourceId{}, monitor).value();
  std::vector<TrueScan> scans;
  std::size_t next = 0;
  for (Packet packet;;) {
    const auto poll = reader->next(packet, {});
    if (!poll || *poll == Poll::kEnd) return scans;
    if (packet.source != SourceId{0}) continue;
    if (packet.bytes.size() == velodyne::kDataBytes)
      hide_classes(packet.bytes, std::span(labels).subspan(kReturns * next++, kReturns));
    const auto decoded = lidar->decode(packet);
    if (!decoded || *decoded == nullptr) continue;
    Scan scan = **decoded;
    bench::deskew_with(truth, T_base_lidar, scan);
    TrueScan& out = scans.emplace_back();
    out.placed.stamp = scan.valid.end;
    out.placed.T_odom_base = truth(scan.valid.end);
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      out.placed.points_base.push_back((T_base_lidar * scan.cloud.xyz[i].cast<double>()).cast<float>());
      out.classes.push_back(static_cast<std::uint8_t>(scan.cloud.intensity[i]));
    }
  }
}

struct Setting {
  const char* name;
  labelling::LabellingConfig config;
};

std::vector<Setting> settings() {
  std::vector<Setting> all{{"as shipped", {}}};
  const auto with = [&](const char* name, auto change) {
    all.push_back({name, {}});
    change(all.back().config);
  };
  with("window alone", [](auto& c) { c.occlusion_between_deg = 0; });
  with("between 1 deg", [](auto& c) { c.occlusion_between_deg = 1; });
  with("between 4 deg", [](auto& c) { c.occlusion_between_deg = 4; });
  with("no z-buffer", [](auto& c) { c.occlusion_m = 100; });
  with("no borders", [](auto& c) { c.border_px = 0; });
  with("neither", [](auto& c) { c.border_px = 0, c.occlusion_m = 100; });
  with("window 9 px", [](auto& c) { c.occlusion_window_px = 9; });
  with("window 15 px", [](auto& c) { c.occlusion_window_px = 15; });
  with("window 25 px", [](auto& c) { c.occlusion_window_px = 25; });
  with("borders 1 px", [](auto& c) { c.border_px = 1; });
  with("borders 4 px", [](auto& c) { c.border_px = 4; });
  with("25 px, 4 px", [](auto& c) { c.border_px = 4, c.occlusion_window_px = 25; });
  return all;
}

/// What became of all points with one setting.
struct Tally {
  std::size_t seen = 0, labelled = 0, wrong = 0;
  double weight = 0, wrong_weight = 0;
  std::map<std::pair<int, int>, std::size_t> confusions;
};

void count(const TrueScan& scan, const std::vector<LabelledPoint>& points, Tally& tally) {
  const Eigen::Isometry3f T_odom_scan(scan.placed.T_odom_base.matrix().cast<float>());
  std::size_t i = 0;
  for (const LabelledPoint& p : points) {  // in the scan's order
    while (T_odom_scan * scan.placed.points_base[i] != p.point_odom) ++i;
    const bool wrong = scan.classes[i] != p.class_id;
    tally.weight += p.weight;
    tally.wrong += wrong ? 1 : 0;
    tally.wrong_weight += wrong ? p.weight : 0;
    if (wrong) ++tally.confusions[{scan.classes[i], p.class_id}];
  }
  tally.labelled += points.size();
}

void print(const char* name, const Tally& t) {
  std::printf("%-14s %8zu points seen, %5.1f %% labelled, %6.3f %% of the labels wrong (%6.3f %% by weight)\n", name,
              t.seen, 100.0 * static_cast<double>(t.labelled) / static_cast<double>(t.seen),
              100.0 * static_cast<double>(t.wrong) / static_cast<double>(t.labelled),
              100.0 * t.wrong_weight / t.weight);
}

void print_confusions(const Tally& t) {
  std::vector<std::pair<std::size_t, std::pair<int, int>>> worst;
  for (const auto& [pair, n] : t.confusions) worst.push_back({n, pair});
  std::sort(worst.rbegin(), worst.rend());
  const auto name = [](int id) {
    return id < 19 ? std::string(kSemanticClasses[static_cast<std::size_t>(id)].name) : "none";
  };
  for (std::size_t i = 0; i < std::min<std::size_t>(worst.size(), 10); ++i)
    std::printf("   %6zu points of %s labelled %s\n", worst[i].first, name(worst[i].second.first).c_str(),
                name(worst[i].second.second).c_str());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "labelling_accuracy RECORDING [every=N]\n"), 2;
  const fs::path folder = argv[1];
  const int every = argc > 2 && std::strncmp(argv[2], "every=", 6) == 0 ? std::max(1, std::atoi(argv[2] + 6)) : 5;
  const auto profile = app::load_profile(folder / "profile.yaml").value();
  const auto size = app::picture_size(profile.camera);
  const auto camera = profile.camera.intrinsics.model(size.width, size.height).value();
  const SE3 T_base_camera = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(profile.camera.base_xyz_rpy.data()));
  const bench::Truth truth(folder / "ground_truth.tum");
  const auto scans = true_scans(folder, profile.robot().T_base_lidar, truth);
  std::vector<fs::path> pictures;
  for (const auto& entry : fs::directory_iterator(folder / "labels")) pictures.push_back(entry.path());
  std::sort(pictures.begin(), pictures.end());

  const auto all = settings();
  std::vector<Tally> tallies(all.size());
  std::vector<LabelledPoint> points;
  for (std::size_t n = 0; n < pictures.size(); n += static_cast<std::size_t>(every)) {
    LabelImage labels;
    if (!networks::decode_label_picture(read_file(pictures[n], 1U << 24U).value(), labels)) return 1;
    const Time t(Duration(std::stoll(pictures[n].stem().string())));
    const auto nearest = std::min_element(scans.begin(), scans.end(), [&](const TrueScan& a, const TrueScan& b) {
      return std::chrono::abs(a.placed.stamp - t) < std::chrono::abs(b.placed.stamp - t);
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
      labelling::PointLabeller labeller(camera, T_base_camera, all[i].config);
      const auto figures = labeller.label(labels, nearest->placed, {.T_odom_base = truth(t)}, points);
      if (!figures) return 1;
      tallies[i].seen += figures->seen;
      count(*nearest, points, tallies[i]);
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) print(all[i].name, tallies[i]);
  print_confusions(tallies[0]);
  return 0;
}
