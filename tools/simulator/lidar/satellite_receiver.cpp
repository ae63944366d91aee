// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/satellite_receiver.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string_view>

#include "fusion/team/site_fit.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

constexpr std::uint64_t kWaveStream = 71, kNoiseStream = 72;
constexpr double kNoise = 0.1;  // of sigma, from second to second
constexpr std::int64_t kNsPerS = 1'000'000'000;

std::uint8_t checksum(std::string_view body) {
  std::uint8_t sum = 0;
  for (const char c : body) sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
  return sum;
}

/// Degrees and minutes, such as "5155.4400000".
std::string angle(double degrees, int digits) {
  constexpr double kParts = 1e7;  // of a minute
  const double minutes = std::round(std::abs(degrees) * 60 * kParts) / kParts, whole = std::floor(minutes / 60);
  char text[32];
  std::snprintf(text, sizeof text, "%0*d%010.7f", digits, static_cast<int>(whole), minutes - 60 * whole);
  return text;
}

}  // namespace

SatelliteReceiver::SatelliteReceiver(const Track& track, double sigma_m, std::int64_t start_utc_ns, std::uint64_t seed)
    : track_(track), sigma_m_(sigma_m), start_utc_ns_(start_utc_ns), seed_(seed) {
  Random random(seed, kWaveStream);
  for (auto& axis : waves_)
    for (Wave& wave : axis)
      wave = {.amplitude_m = sigma_m * std::sqrt(2.0 / 3.0),
              .period_s = random.uniform(300, 1200),
              .phase = random.uniform(0, 2 * std::numbers::pi)};
}

Eigen::Vector2d SatelliteReceiver::place(std::int64_t utc_s) const {
  const Time t = track_.start() + Duration{utc_s * kNsPerS - start_utc_ns_};
  Eigen::Vector2d at = track_.T_world_base(std::max(t, track_.start())).translation().head<2>();
  for (std::size_t axis = 0; axis < 2; ++axis)
    for (const Wave& w : waves_.at(axis))
      at[static_cast<Eigen::Index>(axis)] +=
          w.amplitude_m * std::sin(w.phase + 2 * std::numbers::pi * static_cast<double>(utc_s % 100'000) / w.period_s);
  Random noise(seed_ + static_cast<std::uint64_t>(utc_s), kNoiseStream);
  const auto [x, y] = noise.normal_pair();
  return at + kNoise * sigma_m_ * Eigen::Vector2d(x, y);
}

std::string SatelliteReceiver::place_text(std::int64_t utc_s) const {
  if (sigma_m_ == 0) return "5155.4400,N,00424.1200,E";
  const Eigen::Vector2d geo = team::SiteOrigin{kLatitude_deg, kLongitude_deg}.from_site(place(utc_s));
  return angle(geo.x(), 2) + (geo.x() < 0 ? ",S," : ",N,") + angle(geo.y(), 3) + (geo.y() < 0 ? ",W" : ",E");
}

std::string SatelliteReceiver::sentence(Time t) const {
  using namespace std::chrono;
  const std::int64_t utc_s = (start_utc_ns_ + (t - track_.start()).count()) / kNsPerS;
  const sys_seconds time{seconds{utc_s}};
  const sys_days day = floor<days>(time);
  const year_month_day date{day};
  const hh_mm_ss clock{time - day};
  char body[128];
  std::snprintf(body, sizeof body, "GPRMC,%02d%02d%02d,A,%s,000.0,000.0,%02u%02u%02d,000.0,E",
                static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()), place_text(utc_s).c_str(), static_cast<unsigned>(date.day()),
                static_cast<unsigned>(date.month()), static_cast<int>(date.year()) % 100);
  char sentence[144];
  std::snprintf(sentence, sizeof sentence, "$%s*%02X\r\n", body, static_cast<unsigned>(checksum(body)));
  return sentence;
}

}  // namespace cairn::simulator
