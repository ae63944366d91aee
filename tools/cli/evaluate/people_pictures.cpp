// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/people_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>

#include "drivers/recording/formats/text_lines.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/perception/networks/recorded/label_folder.hpp"
#include "tools/cli/evaluate/path.hpp"
#include "tools/cli/evaluate/people_ways.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

constexpr Duration kSameStamp = std::chrono::milliseconds(1);  // people.csv rounds to microseconds

/// The space that somebody takes.
struct Standing {
  Eigen::Vector2d middle{0, 0};
  double ground = 0;
};

/// How far away somebody is whom the ray meets, seen from above; none: it passes.
std::optional<double> met_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray, const Standing& person) {
  const Eigen::Vector2d away = person.middle - eye.head<2>(), flat = ray.head<2>();
  const double squared = flat.squaredNorm(), nearest = away.dot(flat) / squared;
  const double room = kPersonRadius_m * kPersonRadius_m - (away - nearest * flat).squaredNorm();
  if (!(room >= 0) || nearest < 0) return std::nullopt;
  const double half = std::sqrt(room / squared);
  const auto [low, high] = std::minmax({eye.z() + (nearest - half) * ray.z(), eye.z() + (nearest + half) * ray.z()});
  if (high < person.ground || low > person.ground + kPersonHeight_m) return std::nullopt;
  return away.norm();
}

/// The picture's pixels of people, as rays of the optical frame.
std::vector<Eigen::Vector3d> rays_of_people(const LabelImage& labels, const cameras::CameraModel& model) {
  std::vector<Eigen::Vector3d> rays;
  for (int v = 0; v < labels.height; ++v)
    for (int u = 0; u < labels.width; ++u) {
      if (labels.classes[labels.index(u, v)] != kPersonClass) continue;
      if (const auto ray = model.unproject({u, v})) rays.push_back(*ray);
    }
  return rays;
}

/// For each picture, whether there are rows of it.
std::vector<bool> told(std::span<const Time> stamps, std::span<const PersonRow> tracks) {
  std::vector<bool> there;
  for (const Time t : stamps) {
    const auto row = std::ranges::lower_bound(tracks, t - kSameStamp, {}, &PersonRow::stamp);
    there.push_back(row != tracks.end() && row->stamp <= t + kSameStamp);
  }
  return there;
}

}  // namespace

Ground::Ground(const mapping::SemanticOcTree& world) : world_(world) {
  double x = 0, y = 0;
  world.getMetricMin(x, y, lowest_);
  world.getMetricMax(x, y, highest_);
}

double Ground::at(const Eigen::Vector2d& position) const {
  const auto x = static_cast<float>(position.x()), y = static_cast<float>(position.y());
  const double half = world_.getResolution() / 2;
  octomap::point3d ground;
  const bool met =
      world_.castRay({x, y, static_cast<float>(lowest_ + half)}, {0, 0, 1}, ground, true, highest_ - lowest_);
  return met ? ground.z() - half : lowest_;
}

void count_pixels(const LabelImage& labels, const cameras::CameraModel& model, const SE3& T_base_eye,
                  const Ground& ground, PeopleScan& scan) {
  const SE3 T_world_eye = scan.T_world_base * T_base_eye;
  std::vector<Standing> standing;
  for (const PeopleScan::Person& p : scan.people) standing.push_back({p.position_world, ground.at(p.position_world)});
  for (const Eigen::Vector3d& ray_eye : rays_of_people(labels, model)) {
    const Eigen::Vector3d ray = T_world_eye.rotation() * ray_eye;
    double nearest = std::numeric_limits<double>::infinity();
    PeopleScan::Person* met = nullptr;
    for (std::size_t i = 0; i < standing.size(); ++i)
      if (const auto away = met_at(T_world_eye.translation(), ray, standing[i]); away && *away < nearest) {
        nearest = *away;
        met = &scan.people[i];
      }
    if (met != nullptr) ++met->seen;
  }
}

Result<std::vector<Time>> label_stamps(const fs::path& recording) {
  const fs::path folder = recording / networks::kLabelFolder;
  std::vector<Time> stamps;
  std::error_code error;
  for (fs::directory_iterator file(folder, error), end; !error && file != end; file.increment(error))
    if (const auto ns = recording::parse_integer(file->path().stem().string());
        ns && file->path().extension() == ".png" && std::abs(*ns) <= kLatest_ns)
      stamps.emplace_back(Duration(*ns));
  std::ranges::sort(stamps);
  if (!stamps.empty()) return stamps;
  return Error{Errc::kNotFound,
               "no label pictures say whom the recording's camera saw",
               folder.string(),
               {},
               "take a recording of `cairn simulate` with a camera and --people"};
}

std::vector<Time> judged_stamps(std::span<const Time> stamps, std::span<const PersonRow> tracks, Duration period) {
  const std::vector<bool> has_rows = told(stamps, tracks);
  const Duration apart = std::max(period, kSameScan + Duration(1));  // else join() would take the next picture's rows
  std::vector<Time> judged;
  for (std::size_t i = 0, next = 0; i < stamps.size(); ++i) {
    for (next = std::max(next, i); next < stamps.size() && !has_rows[next];) ++next;
    const bool due = judged.empty() || stamps[i] >= judged.back() + apart;
    const bool rows_soon = next < stamps.size() && stamps[next] < stamps[i] + apart;
    if (has_rows[i] || (due && !rows_soon)) judged.push_back(stamps[i]);
  }
  return judged;
}

Result<std::vector<PeopleScan>> people_pictures(const fs::path& recording, const app::RobotProfile& profile,
                                                std::span<const PersonRow> truth, std::span<const Time> stamps) {
  const auto path = Path::read(recording / "ground_truth.tum");
  if (!path) return path.error();
  const fs::path map = recording / "world.ot";
  const auto world = mapping::load_map(map);
  if (!world) return at(map.string(), world.error());
  const Ground ground(**world);
  const Ways ways(truth);
  const SE3 T_base_eye =
      SE3::from_xyz_rpy(Eigen::Map<const Vector6>(profile.camera.base_xyz_rpy.data())) * cameras::T_camera_optical();
  networks::RecordedSegmenter pictures(recording / networks::kLabelFolder);
  std::vector<PeopleScan> scans;
  Image picture;
  for (const Time t : stamps) {
    picture.stamp = t;
    const auto labels = pictures.segment(picture);
    if (!labels) return labels.error();
    const auto model = profile.camera.intrinsics.model((*labels)->width, (*labels)->height);
    if (!model) return model.error();
    PeopleScan& scan = scans.emplace_back(
        PeopleScan{.stamp = t, .T_world_base = path->at(t), .people = ways.at(t), .visible_from = kVisiblePixels});
    scan.people_z = ground.at(scan.T_world_base.translation().head<2>()) + kPersonHeight_m / 2;
    count_pixels(**labels, *model, T_base_eye, ground, scan);
  }
  return scans;
}

}  // namespace cairn::cli
