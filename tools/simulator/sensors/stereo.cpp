// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/stereo.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "drivers/camera/frame.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

constexpr std::size_t kCurve = 1U << 14U;

const std::array<float, kCurve + 1>& curve() {
  static const std::array<float, kCurve + 1> table = [] {
    std::array<float, kCurve + 1> steps{};
    for (std::size_t i = 0; i <= kCurve; ++i) {
      const double x = static_cast<double>(i) / kCurve;
      steps[i] = static_cast<float>(255.0 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055));
    }
    return steps;
  }();
  return table;
}

/// Nearly N(0, 1): how many of 32 random bits are set. Cheap, and the same everywhere.
float nearly_normal(std::uint32_t bits) { return static_cast<float>(std::popcount(bits) - 16) * 0.35355339F; }

std::byte step(float value) { return static_cast<std::byte>(std::lround(std::clamp(value, 0.0F, 255.0F))); }

struct Pixel {
  float y, u, v;
};

/// BT.601, limited range, from 8-bit sRGB.
Pixel yuv(const Rgb& linear) {
  const float r = srgb(linear.x()), g = srgb(linear.y()), b = srgb(linear.z());
  return {16 + 0.257F * r + 0.504F * g + 0.098F * b, 128 - 0.148F * r - 0.291F * g + 0.439F * b,
          128 + 0.439F * r - 0.368F * g - 0.071F * b};
}

}  // namespace

float srgb(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F) * static_cast<float>(kCurve);
  return curve()[static_cast<std::size_t>(x)];
}

Stereo::Stereo(const StereoConfig& config, const Tracer& tracer, const Crowd& people, const Climate& climate,
               const Trajectory& trajectory, std::uint64_t seed)
    : config_(config), tracer_(tracer), people_(people), climate_(climate), trajectory_(trajectory), seed_(seed) {}

SE3 Stereo::T_world_eye(int eye, Time t) const {
  const SE3 T_left_eye(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, eye == 0 ? 0.0 : -config_.baseline_m, 0));
  return trajectory_.T_world_base(t) * SE3::from_xyz_rpy(config_.base_camera_xyz_rpy) * T_left_eye;
}

double Stereo::exposure_stops(Time t) const {
  if (config_.exposure_error_stops == 0) return config_.exposure_stops;
  constexpr double kWander_s = 1.5, kSpread = 4.0;  // value noise has a standard deviation of about a quarter
  const double wander =
      value_noise({to_seconds(t.time_since_epoch()) / kWander_s, static_cast<double>(seed_ % 8191), 0.0});
  return config_.exposure_stops + config_.exposure_error_stops * kSpread * (wander - 0.5);
}

void Stereo::expose_row(const Instant& instant, const SE3& T_world_eye, int eye, int row, const Shot& shot,
                        std::byte* out, std::byte* labels, SeenPeople* people) const {
  const auto width = static_cast<std::size_t>(config_.lens.width);
  std::vector<Sighting> seen(width);
  look(instant, config_.lens, T_world_eye, row, seen, ClearGlass::kClear);
  const auto noise = static_cast<float>(config_.noise_factor * (climate_.night ? config_.night_noise : config_.noise));
  const double pixel_rad = 1.0 / config_.lens.fx;
  Random random(seed_, shot.n, static_cast<std::uint64_t>(2 * row + eye));
  for (std::size_t u = 0; u + 1 < width; u += 2) {
    const Pixel a = yuv(shot.gain * radiance(seen[u], climate_, instant, pixel_rad));
    const Pixel b = yuv(shot.gain * radiance(seen[u + 1], climate_, instant, pixel_rad));
    const std::uint64_t luma = random.next(), chroma = random.next();
    const auto low = static_cast<std::uint32_t>(chroma), high = static_cast<std::uint32_t>(chroma >> 32U);
    *out++ = step(a.y + noise * nearly_normal(static_cast<std::uint32_t>(luma)));
    *out++ = step(0.5F * (a.u + b.u) + 0.5F * noise * nearly_normal(low));
    *out++ = step(b.y + noise * nearly_normal(static_cast<std::uint32_t>(luma >> 32U)));
    *out++ = step(0.5F * (a.v + b.v) + 0.5F * noise * nearly_normal(high));
  }
  if (people != nullptr) people->add_row(row, T_world_eye.translation(), seen, instant.people);
  if (labels == nullptr) return;
  for (const Sighting& s : seen) *labels++ = static_cast<std::byte>(s.class_id());
}

void cut_eye(const Packet& both, const Lens& lens, std::size_t eye, Packet& out) {
  const auto row_bytes = 2 * static_cast<std::size_t>(lens.width), rows = static_cast<std::size_t>(lens.height);
  out.arrival = both.arrival;
  out.sequence = both.sequence;
  out.bytes.clear();
  camera::append_header(out.bytes,
                        {static_cast<std::uint32_t>(camera::FrameFormat::kYuyv), static_cast<std::uint32_t>(lens.width),
                         static_cast<std::uint32_t>(lens.height), static_cast<std::uint32_t>(row_bytes), true});
  for (std::size_t row = 0; row < rows; ++row) {
    const std::byte* from = both.bytes.data() + camera::kFrameHeaderBytes + (2 * row + eye) * row_bytes;
    out.bytes.insert(out.bytes.end(), from, from + row_bytes);
  }
}

void Stereo::shoot(std::uint64_t n, Time t, Workers& workers, Packet& packet, std::vector<std::byte>& labels,
                   SeenPeople* seen) const {
  const auto width = static_cast<std::size_t>(config_.lens.width),
             height = static_cast<std::size_t>(config_.lens.height);
  const camera::FrameHeader header{static_cast<std::uint32_t>(camera::FrameFormat::kYuyv),
                                   static_cast<std::uint32_t>(2 * width), static_cast<std::uint32_t>(height),
                                   static_cast<std::uint32_t>(4 * width), true};
  packet.bytes.clear();
  camera::append_header(packet.bytes, header);
  packet.bytes.resize(camera::kFrameHeaderBytes + 4 * width * height);
  labels.resize(width * height);
  if (seen != nullptr) seen->begin(people_.size(), config_.lens.height);
  packet.arrival = t;
  packet.sequence = n;
  const Shot shot{n, static_cast<float>(std::exp2(exposure_stops(t)))};
  const auto figures = people_.figures(t);
  workers.for_each(2 * height, [&](std::size_t chunk) {
    const std::size_t eye = chunk % 2, row = chunk / 2;
    const bool rolling = config_.line_time_s > 0;
    const Time then = rolling ? t + from_seconds(config_.line_time_s * static_cast<double>(row)) : t;
    const auto moved = rolling ? people_.figures(then) : std::vector<Figure>();
    const Instant instant{tracer_, rolling ? std::span<const Figure>(moved) : std::span<const Figure>(figures)};
    std::byte* out = packet.bytes.data() + camera::kFrameHeaderBytes + (2 * row + eye) * 2 * width;
    expose_row(instant, T_world_eye(static_cast<int>(eye), then), static_cast<int>(eye), static_cast<int>(row), shot,
               out, eye == 0 ? labels.data() + row * width : nullptr, eye == 0 ? seen : nullptr);
  });
}

}  // namespace cairn::simulator
