// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/shown_cameras.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "drivers/recording/formats/right_eye.hpp"

namespace cairn::app {
namespace {

using clients::CameraMessage;
using recording::SensorKind;

void set_size(const PictureSize& size, CameraMessage& message) {
  message.width = static_cast<std::uint32_t>(size.width);
  message.height = static_cast<std::uint32_t>(size.height);
}

/// Nothing, where the camera is not calibrated.
void set_lens(const cameras::CameraIntrinsics& intrinsics, const PictureSize& size, CameraMessage& message) {
  const auto model = intrinsics.model(size.width, size.height);
  if (!model) return;
  const cameras::CameraParameters& p = model->parameters();
  const bool fisheye = p.distortion.model == cameras::DistortionModel::kEquidistant;
  message.lens = fisheye ? CameraMessage::Lens::kEquidistant : CameraMessage::Lens::kRadTan;
  message.fx = p.fx;
  message.fy = p.fy;
  message.cx = p.cx;
  message.cy = p.cy;
  message.k = p.distortion.k;
  message.baseline_m = intrinsics.baseline_m;
}

Duration latency_of(double ms) { return from_seconds(ms * 1e-3); }

ShownCamera colour(const CameraProfile& p) {
  ShownCamera camera{.message = {.side_by_side = p.driver.side_by_side}, .latency = latency_of(p.driver.latency_ms)};
  set_size(picture_size(p), camera.message);
  set_lens(p.intrinsics, picture_size(p), camera.message);
  return camera;
}

ShownCamera thermal(const ThermalProfile& p) {
  ShownCamera camera{.message = {}, .latency = latency_of(p.driver.latency_ms)};
  set_size(picture_size(p), camera.message);
  set_lens(p.intrinsics, picture_size(p), camera.message);
  return camera;
}

/// The device rectifies.
ShownCamera depth(const depth::Config& p) {
  ShownCamera camera{.message = {.lens = CameraMessage::Lens::kRadTan, .fx = p.fx, .fy = p.fy, .cx = p.cx, .cy = p.cy},
                     .latency = latency_of(p.latency_ms)};
  set_size({p.capture.width, p.capture.height}, camera.message);
  return camera;
}

/// One kind of camera, and what its pictures are like.
struct CameraRow {
  SensorKind kind;
  ShownCamera (*describe)(const RobotProfile&);
};
// By the camera's number.
constexpr std::array<CameraRow, kShownCameras> kCameras{
    CameraRow{.kind = recording::kCamera, .describe = [](const RobotProfile& p) { return colour(p.camera); }},
    CameraRow{.kind = recording::kThermal, .describe = [](const RobotProfile& p) { return thermal(p.thermal); }},
    CameraRow{.kind = recording::kDepth, .describe = [](const RobotProfile& p) { return depth(p.depth.driver); }}};

}  // namespace

std::vector<ShownCamera> shown_cameras(const RobotProfile& profile, std::span<const recording::SourceEntry> sources) {
  std::vector<ShownCamera> cameras;
  for (std::size_t i = 0; i < kCameras.size(); ++i) {
    const auto source = std::ranges::find_if(sources, [&](const recording::SourceEntry& entry) {
      return entry.kind == kCameras[i].kind && entry.id != recording::kRightEye;
    });
    if (source == sources.end()) continue;
    ShownCamera& camera = cameras.emplace_back(kCameras[i].describe(profile));
    camera.message.camera = static_cast<std::uint8_t>(i);
    camera.message.name = source->id;
  }
  return cameras;
}

void show(std::span<const ShownCamera> cameras, ReceiveTask& receive, StreamOutlets& outlets) {
  for (const ShownCamera& camera : cameras) {
    const std::size_t i = camera.message.camera;
    (void)receive.show(kCameras[i].kind, outlets.pictures[i]);
  }
}

}  // namespace cairn::app
