// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/depth_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/camera/frame.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

constexpr double kGrazing = 0.1;  // cosine of incidence, below which nothing is matched

/// Light goes through it or away from it.
bool specular(Material material) { return properties(material).lobe > 1.0 || properties(material).reflectivity == 0.0; }

/// True disparities of a row, pixels; 0 where nothing can be matched.
std::vector<double> disparities(const DepthConfig& config, const std::vector<Sighting>& seen, int row) {
  const double strength = config.lens.fx * config.baseline_m;
  std::vector<double> all(seen.size(), 0.0);
  for (std::size_t u = 0; u < seen.size(); ++u) {
    const Sighting& s = seen[u];
    if (s.sky() || specular(s.material) || -s.normal.dot(s.direction) < kGrazing) continue;
    all[u] = strength / (s.distance * config.lens.direction(static_cast<int>(u), row).x());
  }
  return all;
}

/// What the other imager sees, from right to left: a pixel whose match lies behind that of one further right is hidden.
void hide(std::vector<double>& disparity) {
  double leftmost = 1e9;
  for (std::size_t u = disparity.size(); u-- > 0;) {
    if (disparity[u] == 0) continue;
    const double at = static_cast<double>(u) - disparity[u];
    if (at > leftmost + 0.5) {
      disparity[u] = 0;
    } else {
      leftmost = std::min(leftmost, at);
    }
  }
}

}  // namespace

DepthSensor::DepthSensor(const DepthConfig& config, const Tracer& tracer, const Crowd& people,
                         const Trajectory& trajectory, std::uint64_t seed)
    : config_(config), tracer_(tracer), people_(people), trajectory_(trajectory), seed_(seed) {}

void DepthSensor::match_row(const Instant& instant, const SE3& T_world_camera, int row, std::uint64_t n,
                            std::byte* out) const {
  std::vector<Sighting> seen(static_cast<std::size_t>(config_.lens.width));
  look(instant, config_.lens, T_world_camera, row, seen);
  std::vector<double> disparity = disparities(config_, seen, row);
  hide(disparity);
  Random random(seed_, n, static_cast<std::uint64_t>(row));
  const double strength = config_.lens.fx * config_.baseline_m;
  for (std::size_t u = 0; u < seen.size(); ++u) {
    const double noise = random.normal_pair().first, luck = random.uniform(), mixed = random.uniform();
    const double beside = disparity[u + 1 < seen.size() ? u + 1 : u];
    const bool edge = disparity[u] > 0 && beside > 0 && std::abs(beside - disparity[u]) > 1.0;
    // A matching window on an edge sees both sides.
    const double d = disparity[u] + (edge ? mixed * (beside - disparity[u]) : 0.0) + config_.disparity_noise_px * noise;
    const double measured = config_.disparity_step_px * std::round(d / config_.disparity_step_px);
    const double z = measured > 0 ? strength / measured : 0.0;
    const bool lost = disparity[u] == 0 || luck < config_.dropout || z < config_.min_depth_m || z > config_.max_depth_m;
    const auto millimetres = static_cast<std::uint32_t>(lost ? 0 : std::lround(1000 * z));
    *out++ = static_cast<std::byte>(millimetres & 0xFFU);
    *out++ = static_cast<std::byte>(millimetres >> 8U);
  }
}

void DepthSensor::shoot(std::uint64_t n, Time t, Workers& workers, Packet& packet) const {
  const auto width = static_cast<std::size_t>(config_.lens.width),
             height = static_cast<std::size_t>(config_.lens.height);
  packet.bytes.clear();
  camera::append_header(packet.bytes,
                        {static_cast<std::uint32_t>(camera::FrameFormat::kZ16), static_cast<std::uint32_t>(width),
                         static_cast<std::uint32_t>(height), static_cast<std::uint32_t>(2 * width), true});
  packet.bytes.resize(camera::kFrameHeaderBytes + 2 * width * height);
  packet.arrival = t;
  packet.sequence = n;
  const auto figures = people_.figures(t);
  const Instant instant{tracer_, figures};
  const SE3 T_world_camera = trajectory_.T_world_base(t) * SE3::from_xyz_rpy(config_.base_camera_xyz_rpy);
  workers.for_each(height, [&](std::size_t row) {
    match_row(instant, T_world_camera, static_cast<int>(row), n,
              packet.bytes.data() + camera::kFrameHeaderBytes + 2 * width * row);
  });
}

}  // namespace cairn::simulator
