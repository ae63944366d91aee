// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "hal/clock.hpp"
#include "hal/monitor.hpp"
#include "hal/ports.hpp"
#include "hal/result.hpp"
#include "onboard/app/robot_profile.hpp"

namespace cairn {

/// Where time comes from and how packets are waited for.
enum class Pace {
  kLive,      ///< devices, on the machine's clock
  kRecorded,  ///< a recording, as slowly as it was made
  kMaximum,   ///< a recording, as fast as the machine can
};

/// The one door through which everything from outside enters, and the decoders behind it.
struct Door {
  std::unique_ptr<Clock> owned_clock;
  VirtualClock* virtual_clock = nullptr;  ///< null when live; otherwise to be advanced with every packet
  std::unique_ptr<Source> source;
  std::vector<std::unique_ptr<ScanDecoder>> decoders;  ///< by SourceId; null where a source holds no scans

  [[nodiscard]] const Clock& clock() const { return *owned_clock; }
  [[nodiscard]] ScanDecoder* decoder(SourceId id) const;
  /// Moves virtual time on to `arrival`; live time needs no help.
  void advance_to(Time arrival) {
    if (virtual_clock != nullptr) virtual_clock->advance_to(arrival);
  }
};

/// The profile's devices, listening. Decoders report events to `monitor`, which must outlive the door.
Result<Door> open_devices(const RobotProfile& profile, Monitor& monitor);
/// A recording. What it says of its robot and sensors (name, model, ports, mount) replaces what the profile says.
Result<Door> open_recording(const std::filesystem::path& folder, Pace pace, RobotProfile& profile, Monitor& monitor);

}  // namespace cairn
