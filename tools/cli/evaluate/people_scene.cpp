// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/people_scene.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "onboard/report/figures/trajectory_error.hpp"
#include "tools/cli/evaluate/mover_error.hpp"
#include "tools/cli/evaluate/path.hpp"
#include "tools/cli/evaluate/people_ways.hpp"
#include "tools/cli/evaluate/true_scans.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

template <class Camera>
std::optional<ViewAngle> angle_of(const Camera& profile) {
  const app::PictureSize size = app::picture_size(profile);
  const auto model = profile.intrinsics.model(size.width, size.height);
  if (!model) return std::nullopt;
  const double row = (size.height - 1) / 2.0;
  const auto left = model->unproject({-0.5, row}), right = model->unproject({size.width - 0.5, row});
  if (!left || !right) return std::nullopt;
  return ViewAngle(SE3::from_xyz_rpy(Eigen::Map<const Vector6>(profile.base_xyz_rpy.data())),
                   -std::atan2(left->x(), left->z()), -std::atan2(right->x(), right->z()));
}

bool in_zone(const PeopleScan& scan, const Eigen::Vector2d& position, const PeopleZone& zone) {
  const Eigen::Vector3d& robot = scan.T_world_base.translation();
  if ((position - robot.head<2>()).norm() > zone.within_m) return false;
  const double z = scan.people_z.value_or(robot.z());
  const Eigen::Vector3d p = scan.T_world_base.inverse() * Eigen::Vector3d(position.x(), position.y(), z);
  return zone.angles.empty() || std::ranges::any_of(zone.angles, [&](const ViewAngle& a) { return a.sees(p); });
}

}  // namespace

bool has(const recording::Recording& recording, recording::SensorKind kind) {
  return std::ranges::any_of(recording.sources, [&](const auto& source) { return source.kind == kind; });
}

bool ViewAngle::sees(const Eigen::Vector3d& point_base) const {
  const Eigen::Vector3d p = T_camera_base_ * point_base;
  const double angle = std::atan2(p.y(), p.x());
  return angle <= left_ && angle >= right_;
}

Result<std::vector<ViewAngle>> view_angles(const fs::path& folder, const app::RobotProfile& profile,
                                           const std::string& which) {
  const auto recording = recording::load_recording(folder);
  if (!recording) return at(folder.string(), recording.error());
  std::vector<ViewAngle> angles;
  const auto add = [&](const std::optional<ViewAngle>& angle) {
    if (angle) angles.push_back(*angle);
  };
  if (which != "thermal" && has(*recording, recording::kCamera)) add(angle_of(profile.camera));
  if (which != "camera" && has(*recording, recording::kThermal)) add(angle_of(profile.thermal));
  if (!angles.empty()) return angles;
  return Error{Errc::kNotFound,
               "the recording has no calibrated camera of this kind",
               folder.string(),
               {},
               "name another one with --view; around counts everybody"};
}

Result<std::vector<PeopleScan>> people_scans(const fs::path& recording, const app::RobotProfile& profile,
                                             std::span<const PersonRow> truth) {
  const Ways ways(truth);
  std::vector<PeopleScan> scans;
  const auto path = Path::read(recording / "ground_truth.tum");
  if (!path) return path.error();
  const auto done = for_each_true_scan(recording, profile, *path, [&](const TrueScan& scan) {
    PeopleScan& out = scans.emplace_back(PeopleScan{scan.stamp, scan.T_path_base, ways.at(scan.stamp)});
    for (const TrueScan::Return& r : scan.returns)
      if (r.class_id == MoverTruth::kPersonId)
        for (PeopleScan::Person& person : out.people)
          if ((r.point.head<2>().cast<double>() - person.position_world).norm() < kReturnsWithin_m) ++person.seen;
  });
  if (!done) return done.error();
  return scans;
}

Result<SE3> place_of_odom(const fs::path& run, const fs::path& recording) {
  const fs::path file = run / "trajectory.tum";
  const auto estimate = recording::read_tum(file);
  if (!estimate) return at(file.string(), estimate.error());
  const auto truth = Path::read(recording / "ground_truth.tum");
  if (!truth) return truth.error();
  const auto matched = report::match_by_time(*estimate, truth->poses(), report::TrajectoryErrorOptions{}.max_gap);
  if (matched.empty()) return Error{Errc::kMalformed, "both trajectories have no common time", file.string(), {}, {}};
  return report::align(matched, report::Alignment::kFirst);
}

Eigen::Vector2d middle_in_world(const SE3& T_world_odom, const Eigen::Vector2d& position_odom, double ground) {
  constexpr double kHalfHeight = 0.9;  // m, of a person
  return (T_world_odom * Eigen::Vector3d(position_odom.x(), position_odom.y(), ground + kHalfHeight)).head<2>();
}

JoinedPeople join(std::span<const PeopleScan> scans, std::span<const PersonRow> tracks_world, const PeopleZone& zone) {
  JoinedPeople joined;
  auto track = tracks_world.begin();
  for (const PeopleScan& scan : scans) {
    PeopleFrame& frame = joined.frames.emplace_back(PeopleFrame{scan.stamp, {}, {}});
    for (const PeopleScan::Person& p : scan.people)
      frame.people.push_back(
          {p.id, p.position_world, p.seen >= scan.visible_from && in_zone(scan, p.position_world, zone)});
    for (; track != tracks_world.end() && track->stamp < scan.stamp - kSameScan; ++track) ++joined.without_scan;
    const Time of_this_scan = track == tracks_world.end() ? Time{} : track->stamp;
    for (; track != tracks_world.end() && track->stamp == of_this_scan && track->stamp <= scan.stamp + kSameScan;
         ++track)
      frame.tracks.push_back({track->id, track->position, in_zone(scan, track->position, zone)});
  }
  joined.without_scan += static_cast<std::size_t>(tracks_world.end() - track);
  return joined;
}

}  // namespace cairn::cli
