// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/door/fitted.hpp"

#include <algorithm>
#include <array>

namespace cairn::app {

namespace {

struct WatchedRow {
  recording::SensorKind kind;
  std::optional<safety::Watched> watched;
};
constexpr std::array kWatchedAs{
    WatchedRow{recording::kVelodyne, safety::Watched::kLidar},
    WatchedRow{recording::kScans, safety::Watched::kLidar},
    WatchedRow{recording::kCamera, safety::Watched::kCamera},
    WatchedRow{recording::kThermal, safety::Watched::kThermal},
    WatchedRow{recording::kDepth, safety::Watched::kDepth},
    WatchedRow{recording::kDrive, safety::Watched::kFeedback},
    WatchedRow{recording::kGpio, std::nullopt},  // the e-stop has rules of its own
    WatchedRow{recording::kPeers, std::nullopt},
    WatchedRow{recording::kCommands, std::nullopt},  // freshness is the commander's
};
static_assert(recording::one_row_per_kind(kWatchedAs));

}  // namespace

bool has_kind(std::span<const recording::SourceEntry> sources, recording::SensorKind kind) {
  return std::ranges::find(sources, kind, &recording::SourceEntry::kind) != sources.end();
}

bool has_lidar(std::span<const recording::SourceEntry> sources) {
  return has_kind(sources, recording::kVelodyne) || has_kind(sources, recording::kScans);
}

std::optional<safety::Watched> watched_as(recording::SensorKind kind) {
  return recording::row_of(kind, kWatchedAs).watched;
}

safety::Fitted fitted_with(std::span<const recording::SourceEntry> sources, const RobotProfile& profile) {
  safety::Fitted fitted;
  fitted.drive = has_kind(sources, recording::kDrive) && profile.drive.exists();
  for (const recording::SourceEntry& entry : sources)
    if (const auto watched = watched_as(entry.kind); watched && (entry.kind != recording::kDrive || fitted.drive))
      fitted.watched[static_cast<std::size_t>(*watched)] = true;
  fitted.estop = has_kind(sources, recording::kGpio) && !profile.gpio.driver.estop_line.empty();
  return fitted;
}

}  // namespace cairn::app
