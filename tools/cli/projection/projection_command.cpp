// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/projection/projection_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>

#include "hal/files/file.hpp"
#include "onboard/app/cli/working_line.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/perception/alignment/alignment_score.hpp"
#include "onboard/perception/labelling/projection.hpp"
#include "onboard/perception/mount/mount_watch.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tools/cli/projection/overlay.hpp"
#include "tools/cli/projection/paired_pictures.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

struct ProjectionOptions {
  fs::path recording, config, out;
  int every = 1;
  bool json = false;
};

/// What the command leaves.
struct ProjectionFigures {
  alignment::AlignmentScore score;
  mount::MountWatch motion;
  std::size_t pictures = 0, without_scan = 0, unreadable = 0, scans_without_pose = 0, overlays = 0;
};

/// Draws what one picture and its scan have in common.
class Overlays {
 public:
  Overlays(fs::path folder, const cameras::CameraModel& camera, const SE3& T_base_camera)
      : folder_(std::move(folder)),
        T_optical_base_((T_base_camera * cameras::T_camera_optical()).inverse()),
        projection_(camera, T_base_camera, 0) {}

  Result<void> draw(const PicturePair& pair) {
    const auto points =
        projection_.project(pair.scan.points_base, pair.scan.T_odom_base, {.T_odom_base = pair.T_odom_base});
    const SE3 T_optical_scan = T_optical_base_ * pair.T_odom_base.inverse() * pair.scan.T_odom_base;
    std::vector<Eigen::Vector2d> upright, level;
    for (const alignment::DepthEdge& edge : pair.edges)
      if (const auto pixel = projection_.camera().project(
              T_optical_scan * (0.5F * (edge.inside_base + edge.outside_base)).cast<double>()))
        (edge.kind == alignment::EdgeKind::kUpright ? upright : level).push_back(*pixel);
    const auto png = draw_overlay(pair.picture.view(), points, upright, level);
    if (!png) return png.error();
    return write_file_atomic(folder_ / fmt::format("overlay_{:05}.png", count_++), *png);
  }
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  fs::path folder_;
  SE3 T_optical_base_;
  labelling::Projection projection_;
  std::size_t count_ = 0;
};

Result<cameras::CameraModel> calibrated(const app::RobotProfile& profile, const fs::path& recording) {
  const app::PictureSize size = app::picture_size(profile.camera);
  auto model = profile.camera.intrinsics.model(size.width, size.height);
  if (model || model.error().code != Errc::kNotFound) return model;
  return Error{Errc::kInvalidConfig,
               "the camera is not calibrated",
               recording.string(),
               {},
               "name a profile whose camera.intrinsics say fx, fy, cx and cy, or a calibration, with --config"};
}

Result<ProjectionFigures> compare(const ProjectionOptions& options, const app::RobotProfile& profile,
                                  const cameras::CameraModel& camera) {
  auto pairs = PairedPictures::open(options.recording, profile);
  if (!pairs) return pairs.error();
  const SE3 T_base_camera = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(profile.camera.base_xyz_rpy.data()));
  ProjectionFigures figures{
      .score = alignment::AlignmentScore(camera, T_base_camera),
      .motion = mount::MountWatch(camera, T_base_camera, profile.perception.mount, std::chrono::hours(24))};
  Overlays overlays(options.out, camera, T_base_camera);
  alignment::PictureEdges edges;
  const auto done = (*pairs)->for_each(options.every, [&](const PicturePair& pair) -> Result<void> {
    if (pair.picture.width != camera.width() || pair.picture.height != camera.height())
      return Error{Errc::kInvalidConfig,
                   "a picture has another size than the profile's camera",
                   options.recording.string(),
                   {},
                   fmt::format("{}x{}, not {}x{}: set camera.capture and camera.side_by_side", pair.picture.width,
                               pair.picture.height, camera.width(), camera.height())};
    edges.compute(pair.picture.view());
    figures.motion.look(pair.picture, pair.T_odom_base, pair.scan.epoch);
    figures.score.add(edges, pair.edges, pair.scan.T_odom_base.inverse() * pair.T_odom_base);
    return options.out.empty() ? Result<void>() : overlays.draw(pair);
  });
  if (!done) return done.error();
  figures.pictures = (*pairs)->pictures();
  figures.without_scan = (*pairs)->without_scan();
  figures.unreadable = (*pairs)->unreadable();
  figures.scans_without_pose = (*pairs)->scans_without_pose();
  figures.overlays = overlays.count();
  return figures;
}

/// Whether the given mount fits best; nothing where there are too few edges to say.
std::optional<bool> verdict(const alignment::AlignmentScore& score) {
  if (score.edges() < alignment::AlignmentScore::kLeastEdges) return std::nullopt;
  return score.given_mount_is_best();
}

constexpr double kToDegrees = 180 / std::numbers::pi;

/// How far the camera is turned from its mount, by the robot's motion; null: it moved too little.
report::Json by_motion(const mount::MountWatch& watch) {
  const auto& e = watch.estimate();
  if (!e) return nullptr;
  report::Json json{{"pairs", watch.pairs()}};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    json["turn_deg"].push_back(kToDegrees * e->turn_rad[axis]);
    json["deviation_deg"].push_back(kToDegrees * e->deviation_rad(axis));
  }
  return json;
}

std::string motion_text(const mount::MountWatch& watch) {
  const auto& e = watch.estimate();
  if (!e) return "by motion: too little was seen; eight seconds of driving and turning tell how the camera is turned\n";
  const Eigen::Vector3d turn = kToDegrees * e->turn_rad;
  return fmt::format(
      "by motion: turned by roll {:.2f} ± {:.2f}, pitch {:.2f} ± {:.2f}, yaw {:.2f} ± {:.2f} degrees "
      "from the given mount ({} pairs of pictures)\n",
      turn.x(), kToDegrees * e->deviation_rad(0), turn.y(), kToDegrees * e->deviation_rad(1), turn.z(),
      kToDegrees * e->deviation_rad(2), watch.pairs());
}

report::Json to_json(const ProjectionOptions& options, const ProjectionFigures& f) {
  report::Json json{{"recording", options.recording.string()},
                    {"pictures", f.pictures},
                    {"without_scan", f.without_scan},
                    {"unreadable_packets", f.unreadable},
                    {"scans_without_pose", f.scans_without_pose},
                    {"edges", f.score.edges()},
                    {"mounts", report::Json::array()}};
  for (const alignment::EdgeDistance& d : f.score.distances())
    json["mounts"].push_back(
        {{"mount", d.mount}, {"median_px", d.median_px}, {"within_2px", d.within_2px}, {"closeness", d.closeness}});
  const auto best = verdict(f.score);
  json["given_mount_is_best"] = best ? report::Json(*best) : report::Json(nullptr);
  json["by_motion"] = by_motion(f.motion);
  json["overlays"] = f.overlays;
  return json;
}

void print_figures(const ProjectionFigures& f) {
  std::cout << fmt::format("{} pictures ({} without a scan), {} depth edges in them\n", f.pictures, f.without_scan,
                           f.score.edges());
  if (f.scans_without_pose > 0)
    std::cout << fmt::format("the pose of {} scans is not known: they are left out\n", f.scans_without_pose);
  if (f.unreadable > 0) std::cout << fmt::format("{} packets could not be decoded\n", f.unreadable);
  std::cout << "mount         median  within 2 px  closeness\n";
  for (const alignment::EdgeDistance& d : f.score.distances())
    std::cout << fmt::format("{:<12}  {:>4.1f} px  {:>9.1f} %  {:>9.4f}\n", d.mount, d.median_px, 100 * d.within_2px,
                             d.closeness);
  const auto best = verdict(f.score);
  std::cout << (!best   ? "too few edges to judge the mount\n"
                : *best ? "the given mount fits best\n"
                        : "a turned mount fits better: check intrinsics, T_base_camera and T_base_lidar\n")
            << motion_text(f.motion);
}

int evaluate_projection(const ProjectionOptions& options) {
  const auto chosen = app::choose_profile(options.config, options.recording);
  if (!chosen) return app::fail(chosen.error());
  const auto camera = calibrated(chosen->profile, options.recording);
  if (!camera) return app::fail(camera.error());
  std::error_code error;
  if (!options.out.empty()) fs::create_directories(options.out, error);
  if (error) return app::fail({Errc::kIo, "cannot create the folder", options.out.string(), {}, error.message()});
  const auto figures =
      app::while_working("projecting scans into pictures", [&] { return compare(options, chosen->profile, *camera); });
  if (!figures) return app::fail(figures.error());
  if (options.json) return app::print(to_json(options, *figures));
  print_figures(*figures);
  return app::kDone;
}

}  // namespace

void add_projection_command(app::Commands& commands, CLI::App& evaluate) {
  CLI::App* sub =
      evaluate.add_subcommand("projection", "how well the LiDAR's depth edges meet edges of the camera's pictures");
  const auto o = std::make_shared<ProjectionOptions>();
  sub->add_option("recording", o->recording, "folder of a recording with LiDAR and camera")
      ->required()
      ->check(CLI::ExistingDirectory);
  sub->add_option("--config", o->config, "robot profile with mounts and intrinsics; default: the recording's own");
  sub->add_option("--out", o->out, "folder for pictures with the LiDAR's points over them; default: none are drawn");
  sub->add_option("--every", o->every, "take every so many pictures only")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->callback([&commands, o] { commands.job = [o] { return evaluate_projection(*o); }; });
}

}  // namespace cairn::cli
