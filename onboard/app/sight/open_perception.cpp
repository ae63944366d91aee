// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/sight/open_perception.hpp"

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>

#include "onboard/app/door/fitted.hpp"
#include "onboard/perception/networks/open_networks.hpp"
#include "onboard/perception/networks/recorded/box_file.hpp"
#include "onboard/perception/networks/recorded/label_folder.hpp"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

/// Null: the recording holds boxes alone.
Result<std::unique_ptr<Segmenter>> open_recorded(const fs::path& recording) {
  const fs::path folder = recording / networks::kLabelFolder;
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored) && fs::exists(recording / networks::kBoxFile, ignored))
    return std::unique_ptr<Segmenter>();
  if (!fs::is_directory(folder, ignored))
    return Error{Errc::kNotFound,
                 "the recording holds neither labels nor boxes",
                 folder.string(),
                 {},
                 "`cairn label` makes them; --networks run asks the profile's network"};
  return std::unique_ptr<Segmenter>(std::make_unique<networks::RecordedSegmenter>(folder));
}

/// Null: its file is missing, which is an event.
Result<std::unique_ptr<Segmenter>> open_network(const networks::NetworkConfig& config, const fs::path& profile_file,
                                                Monitor& monitor) {
  networks::NetworkFacts facts;
  auto opened = networks::open_segmenter(config, networks::model_folders(profile_file), &facts);
  if (opened && !facts.note().empty()) monitor.event({}, "perception", facts.note());
  if (opened || opened.error().code != Errc::kNotFound) return opened;
  monitor.event({}, "perception", "nothing is labelled: " + to_string(opened.error()));
  return std::unique_ptr<Segmenter>();
}

/// None: the camera's calibration is missing, which is an event.
Result<std::optional<LabellingSetup>> set_up(const RobotProfile& profile, Monitor& monitor) {
  const CameraProfile& camera = profile.camera;
  if (!camera.intrinsics.calibrated()) {
    monitor.event({}, "perception", "nothing is labelled: camera.intrinsics of the profile are not set");
    return std::nullopt;
  }
  const PictureSize size = picture_size(camera);
  const auto model = camera.intrinsics.model(size.width, size.height);
  if (!model) return at("camera.intrinsics", model.error());
  return LabellingSetup{*model, SE3::from_xyz_rpy(Eigen::Map<const Vector6>(camera.base_xyz_rpy.data())),
                        profile.perception.labelling};
}

}  // namespace

bool wants_camera(const RunOptions& options, const RobotProfile& profile) {
  return options.networks == NetworkUse::kRun && profile.perception.networks.segmentation.exists() &&
         profile.camera.exists();
}

Result<Perception> open_perception(const RunOptions& options, const RobotProfile& profile,
                                   const std::filesystem::path& profile_file,
                                   std::span<const recording::SourceEntry> sources, Monitor& monitor) {
  Perception off, on;
  const networks::NetworkConfig& network = profile.perception.networks.segmentation;
  const bool recorded = options.networks == NetworkUse::kRecorded;
  if (options.networks == NetworkUse::kOff || (!recorded && !network.exists())) return off;
  if (!has_kind(sources, recording::kCamera)) {
    monitor.event({}, "perception", "nothing is labelled: there is no colour camera");
    return off;
  }
  auto segmenter = recorded ? open_recorded(options.recording) : open_network(network, profile_file, monitor);
  if (!segmenter) return segmenter.error();
  auto setup = set_up(profile, monitor);
  if (!setup) return setup.error();
  if (*segmenter == nullptr || !*setup) return off;
  auto camera = camera::Camera::create(profile.camera.driver);
  if (!camera) return at("camera", camera.error());
  const PictureForm form{.width = (*setup)->camera.width(),
                         .height = (*setup)->camera.height(),
                         .side_by_side = profile.camera.driver.side_by_side,
                         .judged = !recorded};
  on.parts = {.reader = std::make_unique<ColourReader>(std::move(*camera), form),
              .segmenter = std::move(*segmenter),
              .period = from_seconds(1 / network.rate_hz)};
  on.labelling = std::move(*setup);
  return on;
}

}  // namespace cairn::app
