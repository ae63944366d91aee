// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/sight/open_people.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "onboard/app/door/fitted.hpp"
#include "onboard/app/sight/eye_profile.hpp"
#include "onboard/perception/networks/open_networks.hpp"
#include "onboard/perception/networks/recorded/box_file.hpp"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;
using people::Eye;

void nobody_seen(const EyeProfile& eye, const std::string& why, Monitor& monitor) {
  monitor.event({}, "people", std::string("no people are seen by ") + eye.name + ": " + why);
}

/// Null: nothing is recorded of this eye.
Result<std::unique_ptr<Detector>> open_recorded(const fs::path& recording, const std::string& id, Monitor& monitor) {
  std::error_code ignored;
  const fs::path file = recording / networks::kBoxFile;
  if (!fs::exists(file, ignored)) return std::unique_ptr<Detector>();
  auto opened = networks::RecordedDetector::open(file, id);
  if (!opened) return opened.error();
  if (const auto& damage = (*opened)->damage()) monitor.event({}, "people", to_string(*damage));
  if ((*opened)->pictures() == 0) return std::unique_ptr<Detector>();
  return std::unique_ptr<Detector>(std::move(*opened));
}

/// Null: its file is missing, which is an event.
Result<std::unique_ptr<Detector>> open_network(const EyeProfile& eye, const fs::path& profile_file, Monitor& monitor) {
  networks::NetworkFacts facts;
  auto opened = networks::open_detector(eye.network, networks::model_folders(profile_file), &facts);
  if (opened && !facts.note().empty()) monitor.event({}, "people", facts.note());
  if (opened || opened.error().code != Errc::kNotFound) return opened;
  nobody_seen(eye, to_string(opened.error()), monitor);
  return std::unique_ptr<Detector>();
}

/// Adds one eye to `watch`, where everything is there that it needs.
Result<void> add_eye(Eye which, const RunOptions& options, const RobotProfile& profile, const fs::path& profile_file,
                     std::span<const recording::SourceEntry> sources, Monitor& monitor, PeopleWatch& watch) {
  const EyeProfile eye = profile_of(which, profile);
  const bool recorded = options.networks == NetworkUse::kRecorded;
  if (!recorded && !eye.network.exists()) return {};
  const auto source = std::ranges::find(sources, eye.kind, &recording::SourceEntry::kind);
  if (source == sources.end()) {
    if (!recorded) nobody_seen(eye, "there is no such camera", monitor);
    return {};
  }
  auto detector =
      recorded ? open_recorded(options.recording, source->id, monitor) : open_network(eye, profile_file, monitor);
  if (!detector) return detector.error();
  if (*detector == nullptr) return {};
  if (!eye.intrinsics.calibrated()) {
    nobody_seen(eye, std::string(eye.name) + ".intrinsics of the profile are not set", monitor);
    return {};
  }
  const auto model = eye.intrinsics.model(eye.size.width, eye.size.height);
  if (!model) return at(std::string(eye.name) + ".intrinsics", model.error());
  const bool side_by_side = which == Eye::kVisible && profile.camera.driver.side_by_side;
  auto reader = open_reader(which, profile, {model->width(), model->height(), side_by_side, !recorded});
  if (!reader) return reader.error();
  watch.setup->eyes.push_back({which, *model, SE3::from_xyz_rpy(Eigen::Map<const Vector6>(eye.base_xyz_rpy.data()))});
  watch.detectors.push_back(
      {which, source->id, std::move(*reader), std::move(*detector), from_seconds(1 / eye.network.rate_hz)});
  return {};
}

}  // namespace

bool wants_eye(Eye which, const RunOptions& options, const RobotProfile& profile) {
  const EyeProfile eye = profile_of(which, profile);
  return options.networks == NetworkUse::kRun && eye.network.exists() && eye.exists &&
         profile.perception.people.follow != "never";
}

bool people_by_depth(const RobotProfile& profile, std::span<const recording::SourceEntry> sources) {
  if (!has_kind(sources, recording::kDepth) || profile.depth.map.rate_hz <= 0) return false;
  const std::string& points = profile.perception.people.points;
  return points == "depth" || (points == "auto" && !has_lidar(sources));
}

Result<PeopleWatch> open_people(const RunOptions& options, const RobotProfile& profile, const fs::path& profile_file,
                                std::span<const recording::SourceEntry> sources, Monitor& monitor) {
  PeopleWatch watch;
  const people::PeopleConfig& config = profile.perception.people;
  if (config.follow == "never") return watch;
  const bool by_depth = people_by_depth(profile, sources);
  if (config.points == "depth" && !by_depth) {
    monitor.event({}, "people",
                  "nobody is followed: perception.people.points is depth, and the map gets no clouds of a depth "
                  "camera; set depth.map.rate_hz, or points to scans");
    return watch;
  }
  watch.setup = PeopleSetup{.config = config, .eyes = {}, .by_depth = by_depth};
  if (options.networks != NetworkUse::kOff)
    for (const Eye eye : {Eye::kVisible, Eye::kThermal})
      if (const auto added = add_eye(eye, options, profile, profile_file, sources, monitor, watch); !added)
        return added.error();
  if (watch.detectors.empty() && config.follow == "auto") watch.setup.reset();
  return watch;
}

}  // namespace cairn::app
