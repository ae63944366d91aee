// SPDX-License-Identifier: Apache-2.0
// Four ways to fuse the labels of pictures in voxels, over the same points: Cairn's evidence in 31 bits, Bayes' rule
// with 19 floats, the majority of votes, and the last label. Judged by the simulator's true map.
//   cairn simulate --scene street --seconds 60 --seed 70001 --sensors lidar,camera --out sim
//   cairn label sim/robot_1 --config robot.yaml --out answers      # or the truth that is in sim/robot_1/labels
//   label_fusion sim/robot_1 [LABELS] [every=N]
// Poses and deskewing are the simulator's, so that nothing but the fusion differs.
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <tuple>

#include "hal/files/file.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/mapping/mapper.hpp"
#include "onboard/perception/labelling/point_labeller.hpp"
#include "onboard/perception/networks/recorded/label_picture.hpp"
#include "onboard/report/labels/label_measures.hpp"
#include "tests/bench/recorded_drive.hpp"

namespace {

using namespace cairn;
namespace fs = std::filesystem;

constexpr unsigned kClasses = 19;

/// What the other three ways keep of a voxel.
struct Rivals {
  std::array<double, kClasses> nats{};
  std::array<unsigned, kClasses> votes{};
  unsigned last = 0;
};
using Voxel = std::tuple<std::uint16_t, std::uint16_t, std::uint16_t>;

unsigned best(const auto& values) { return static_cast<unsigned>(std::ranges::max_element(values) - values.begin()); }

class Contest {
 public:
  explicit Contest(const mapping::MappingConfig& config) : trust_(config.label_trust), mapper_(config, workers_) {}

  void insert(const labelling::PlacedScan& scan, const Eigen::Vector3f& origin_base) {
    const Eigen::Isometry3f T(scan.T_odom_base.matrix().cast<float>());
    std::vector<Eigen::Vector3f> points;
    for (const auto& p : scan.points_base) points.push_back(T * p);
    if (!mapper_.insert(points, T * origin_base)) std::abort();
  }

  void label(const std::vector<LabelledPoint>& points) {
    mapper_.label(points);
    std::map<Voxel, std::pair<std::array<double, kClasses>, unsigned>> picture;
    for (const LabelledPoint& p : points) {
      octomap::OcTreeKey key;
      if (!mapper_.tree().coordToKeyChecked(p.point_odom.x(), p.point_odom.y(), p.point_odom.z(), key)) continue;
      auto& [nats, count] = picture[{key[0], key[1], key[2]}];
      nats[p.class_id] += trust_ * mapping::gain_256ths(p.probability) / 256.0 * p.weight / 255;
      ++count;
      Rivals& voxel = rivals_[{key[0], key[1], key[2]}];
      ++voxel.votes[p.class_id];
      voxel.last = p.class_id;
    }
    for (const auto& [key, seen] : picture)
      for (unsigned k = 0; k < kClasses; ++k) rivals_[key].nats[k] += seen.first[k] / seen.second;
  }

  void judge(const mapping::SemanticOcTree& truth) const {
    std::array<report::LabelConfusion, 4> found;
    for (auto leaf = mapper_.tree().begin_leafs(); leaf != mapper_.tree().end_leafs(); ++leaf) {
      const auto label = report::label_of(mapper_.tree(), *leaf);
      const auto* node = truth.search(leaf.getCoordinate());
      if (!label.any() || node == nullptr) continue;
      const auto right = report::label_of(truth, *node);
      const auto key = leaf.getKey();
      const auto rival = rivals_.find({key[0], key[1], key[2]});
      if (!right.any() || rival == rivals_.end()) continue;
      const std::array<unsigned, 4> said{label.class_id(), best(rival->second.nats), best(rival->second.votes),
                                         rival->second.last};
      for (std::size_t i = 0; i < said.size(); ++i) found[i].add(right.class_id(), said[i], 1);
    }
    for (std::size_t i = 0; const char* name : {"evidence in 31 bits", "19 floats", "majority", "last label"}) {
      const report::LabelConfusion& c = found[i++];
      std::printf("%-20s %8zu voxels, accuracy %6.2f %%, mIoU %6.2f %%\n", name, static_cast<std::size_t>(c.total()),
                  100 * c.agreement().value_or(0), 100 * c.miou(report::kMinTrueVoxels).value_or(0));
    }
    print_classes(found[0]);
  }

 private:
  static void print_classes(const report::LabelConfusion& c) {
    for (std::size_t k = 0; k < kClasses; ++k)
      if (c.voxels_of(k) >= report::kMinTrueVoxels)
        std::printf("  %-14s %7zu voxels, IoU %5.1f %%\n", std::string(kSemanticClasses[k].name).c_str(),
                    static_cast<std::size_t>(c.voxels_of(k)), 100 * c.iou(k).value_or(0));
  }

  double trust_;
  Workers workers_{1};
  mapping::Mapper mapper_;
  std::map<Voxel, Rivals> rivals_;
};

std::vector<labelling::PlacedScan> scans_of(const fs::path& folder, const SE3& T_base_lidar,
                                            const bench::Truth& truth) {
  auto reader = recording::RecordingReader::open(folder).value();
  Monitor monitor;
  const auto lidar = velodyne::Lidar::create({}, SourceId{}, monitor).value();
  std::vector<labelling::PlacedScan> scans;
  for (Packet packet;;) {
    const auto poll = reader->next(packet, {});
    if (!poll || *poll == Poll::kEnd) return scans;
    if (packet.source != SourceId{0}) continue;
    const auto decoded = lidar->decode(packet);
    if (!decoded || *decoded == nullptr) continue;
    Scan scan = **decoded;
    bench::deskew_with(truth, T_base_lidar, scan);
    labelling::PlacedScan& out = scans.emplace_back();
    out.stamp = scan.valid.end;
    out.T_odom_base = truth(scan.valid.end);
    for (const auto& p : scan.cloud.xyz) out.points_base.push_back((T_base_lidar * p.cast<double>()).cast<float>());
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "label_fusion RECORDING [LABELS] [every=N]\n"), 2;
  const fs::path folder = argv[1];
  fs::path answers = folder / "labels";
  int every = 3;
  for (int i = 2; i < argc; ++i) {
    if (std::strncmp(argv[i], "every=", 6) == 0)
      every = std::max(1, std::atoi(argv[i] + 6));
    else
      answers = argv[i];
  }
  const auto profile = app::load_profile(folder / "profile.yaml").value();
  const auto size = app::picture_size(profile.camera);
  const auto camera = profile.camera.intrinsics.model(size.width, size.height).value();
  const SE3 T_base_camera = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(profile.camera.base_xyz_rpy.data()));
  const SE3 T_base_lidar = profile.robot().T_base_lidar;
  const bench::Truth truth(folder / "ground_truth.tum");
  const auto scans = scans_of(folder, T_base_lidar, truth);
  labelling::PointLabeller labeller(camera, T_base_camera, profile.perception.labelling);
  Contest contest(profile.mapping);
  for (const auto& scan : scans) contest.insert(scan, T_base_lidar.translation().cast<float>());
  std::vector<fs::path> pictures;
  for (const auto& entry : fs::directory_iterator(answers)) pictures.push_back(entry.path());
  std::sort(pictures.begin(), pictures.end());
  std::vector<LabelledPoint> points;
  for (std::size_t n = 0; n < pictures.size(); n += static_cast<std::size_t>(every)) {
    LabelImage labels;
    if (!networks::decode_label_picture(read_file(pictures[n], 1U << 24U).value(), labels)) return 1;
    const Time t(Duration(std::stoll(pictures[n].stem().string())));
    const auto nearest = std::ranges::min_element(
        scans, {}, [&](const labelling::PlacedScan& scan) { return std::chrono::abs(scan.stamp - t); });
    if (!labeller.label(labels, *nearest, {.T_odom_base = truth(t)}, points)) return 1;
    contest.label(points);
  }
  const auto world = mapping::load_map(folder / "world.ot");
  if (!world) return std::fprintf(stderr, "%s\n", to_string(world.error()).c_str()), 1;
  contest.judge(**world);
  return 0;
}
