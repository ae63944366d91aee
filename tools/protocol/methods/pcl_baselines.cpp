// SPDX-License-Identifier: Apache-2.0
// PCL's ICP, point-to-plane ICP, GICP and NDT on the pairs of the protocol: pcl_baselines PAIR [STARTS] leaves pcl.json
// in the pair's folder. Built by tools/protocol.sh alone; no other program of the project knows PCL.
//
// As in the book (section 4.6.3) pairs are sought within 2 m, in at most 30 iterations; everything else is PCL's
// default. The source is thinned to as many voxels as our own methods take (VoxelMatcher::kMostSources).
#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ndt.h>
#include <pcl/search/kdtree.h>

#include <cstdlib>
#include <iostream>
#include <optional>

#include "fusion/matching/features/map_voxels.hpp"
#include "fusion/matching/features/sample.hpp"
#include "hal/clock.hpp"
#include "tools/protocol/methods/attempts.hpp"
#include "tools/protocol/methods/run_methods.hpp"
#include "tools/protocol/pairs/map_pair.hpp"

namespace cairn::protocol {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using NormalCloud = pcl::PointCloud<pcl::PointNormal>;

constexpr double kGateM = 2;                  // the book's search gate (section 4.6.3)
constexpr int kIterations = 30;               // the book's (section 4.6.3)
constexpr std::size_t kMostSources = 20'000;  // VoxelMatcher::kMostSources
constexpr double kNormalRadiusM = 0.35;       // as our own point-to-plane ICP has it
constexpr float kNdtCellM = 1;                // PCL's tutorial. Chosen by hand, not tuned

/// PCL keeps the number of iterations to itself.
template <class Registration>
struct Counted : Registration {
  using Moved = typename Registration::PointCloudSource;
  [[nodiscard]] int iterations() const { return this->nr_iterations_; }
};
using Icp = Counted<pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ>>;
using PlaneIcp = Counted<pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal>>;
using Gicp = Counted<pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ>>;
using Ndt = Counted<pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ>>;

Cloud::Ptr cloud_of(const mapping::SemanticOcTree& map, std::size_t most) {
  const auto centres = occupied_centres(map);
  Cloud::Ptr cloud(new Cloud);
  for (const Eigen::Vector3f& p : matching::sample(std::span<const Eigen::Vector3f>(centres), most))
    cloud->push_back({p.x(), p.y(), p.z()});
  return cloud;
}

/// `surface` holds all that the normals are taken from.
NormalCloud::Ptr with_normals(const Cloud::Ptr& cloud, const Cloud::Ptr& surface) {
  pcl::NormalEstimation<pcl::PointXYZ, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchSurface(surface);
  estimation.setSearchMethod(pcl::search::KdTree<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>));
  estimation.setRadiusSearch(kNormalRadiusM);
  NormalCloud::Ptr out(new NormalCloud);
  estimation.compute(*out);
  for (std::size_t i = 0; i < cloud->size(); ++i) (*out)[i].getVector3fMap() = (*cloud)[i].getVector3fMap();
  std::erase_if(out->points, [](const auto& p) { return !std::isfinite(p.normal_x); });
  out->width = static_cast<std::uint32_t>(out->points.size());
  return out;
}

struct Clouds {
  Cloud::Ptr a, b, all_of_b;
};

/// `set_up` gives the clouds to the method; what it, and a first look, cost is the preparation.
template <class Registration, class SetUp>
MethodRun run(const MapPair& pair, std::string method, int count, const SetUp& set_up) {
  MethodRun run{std::move(method), 0, {}, {}};
  std::optional<VoxelDistance> distance;
  if (has_rms(pair)) distance.emplace(pair);
  Registration registration;
  Duration began = thread_cpu_time();
  set_up(registration);
  registration.setMaxCorrespondenceDistance(kGateM);
  typename Registration::Moved moved;
  // Fills what PCL prepares on first use and keeps: trees and covariances.
  registration.setMaximumIterations(1);
  registration.align(moved, pair.T_a_b.matrix().cast<float>());
  registration.setMaximumIterations(kIterations);
  run.preparation_s = to_seconds(thread_cpu_time() - began);
  for (const int start : chosen_starts(count)) {
    const SE3 from = start_pose(pair.T_a_b, starts().at(static_cast<std::size_t>(start)));
    began = thread_cpu_time();
    registration.align(moved, from.matrix().cast<float>());
    const double seconds = to_seconds(thread_cpu_time() - began);
    const Eigen::Matrix4d T = registration.getFinalTransformation().template cast<double>();
    const SE3 T_a_b(Eigen::Matrix3d(T.topLeftCorner<3, 3>()), Eigen::Vector3d(T.topRightCorner<3, 1>()));
    run.attempts.push_back({start, T_a_b, error_of(T_a_b, pair.T_a_b), seconds, registration.iterations(), false, {}});
    if (distance) run.attempts.back().rms_m = distance->rms(T_a_b);
  }
  return run;
}

std::vector<MethodRun> run_all(const MapPair& pair, int count) {
  const Clouds clouds{cloud_of(*pair.a, matching::kMaxVoxels), cloud_of(*pair.b, kMostSources),
                      cloud_of(*pair.b, matching::kMaxVoxels)};
  const auto points = [&](auto& registration) {
    registration.setInputTarget(clouds.a);
    registration.setInputSource(clouds.b);
  };
  std::vector<MethodRun> runs;
  runs.push_back(run<Icp>(pair, "icp", count, points));
  if (pair.kind == kMission) return runs;  // the book has no other beside its own there
  runs.push_back(run<PlaneIcp>(pair, "p2plane", count, [&](PlaneIcp& registration) {
    registration.setInputTarget(with_normals(clouds.a, clouds.a));
    registration.setInputSource(with_normals(clouds.b, clouds.all_of_b));
  }));
  runs.push_back(run<Gicp>(pair, "gicp", count, points));
  runs.push_back(run<Ndt>(pair, "ndt", count, [&](Ndt& registration) {
    registration.setResolution(kNdtCellM);
    registration.setTransformationEpsilon(
        1e-6);  // PCL's default is above the square of a whole step: it would not move
    points(registration);
  }));
  return runs;
}

}  // namespace
}  // namespace cairn::protocol

int main(int argc, char** argv) {
  using namespace cairn;
  if (argc < 2) return std::cerr << "pcl_baselines PAIR [STARTS]\n", 2;
  const std::filesystem::path dir = argv[1];
  const int starts = argc > 2 ? std::clamp(std::atoi(argv[2]), 1, protocol::kStarts) : protocol::kStarts;
  const auto pair = protocol::load_pair(dir);
  const auto saved =
      pair ? protocol::save_runs(protocol::run_all(*pair, starts), dir / "pcl.json") : Result<void>(pair.error());
  if (saved) return 0;
  std::cerr << "pcl_baselines: " << to_string(saved.error()) << '\n';
  return 1;
}
