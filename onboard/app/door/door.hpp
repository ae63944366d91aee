// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/drive/can/can_link.hpp"
#include "drivers/gpio/gpio_lines.hpp"
#include "drivers/peers/peer_port.hpp"
#include "drivers/recording/formats/recording.hpp"
#include "hal/clock.hpp"
#include "hal/monitor.hpp"
#include "hal/ports.hpp"
#include "hal/result.hpp"
#include "onboard/app/door/devices.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/scheduler/schedule_log.hpp"

namespace cairn::app {

/// One way in: a device or its recording, and what its bytes mean.
struct Input {
  recording::SourceEntry entry;
  std::unique_ptr<Source> source;
  std::unique_ptr<ScanDecoder> scans;    ///< null where it holds no scans
  drive::CanLink* can = nullptr;         ///< the same source, live: it can be spoken to, too
  gpio::GpioLines* lines = nullptr;      ///< likewise
  std::function<Losses()> losses;        ///< live: what the device lost; may be empty
  peer_link::PeerPort* peers = nullptr;  ///< the same source, live: it can be spoken to, too
};

/// The one door through which everything from outside enters. The index of an input is its SourceId.
struct Door {
  std::vector<Input> inputs;
  recording::Recording recording;                  ///< what it is, or will be, as a recording
  std::optional<scheduler::ScheduleLog> schedule;  ///< of the live run that made the recording
};

/// Which devices a live run opens: those it uses, or all of the profile's, because it records them.
enum class Devices : bool { kUsed, kAll };

/// The profile's devices, listening. Decoders report events to `monitor`, which must outlive the door, as must `clock`.
Result<Door> open_devices(const RobotProfile& profile, Devices which, const Clock& clock, Monitor& monitor);
/// A recording. What it says of its robot and sensors (name, model, ports, mount) replaces what the profile says. A
/// source whose file cannot be opened says so as its first and only packet.
Result<Door> open_recording(const std::filesystem::path& folder, RobotProfile& profile, Monitor& monitor);
/// A recording whose sources behave like devices: their packets arrive again, from half a second from now on, for a run
/// that is live. `clock` must outlive the door.
Result<Door> play_recording(const std::filesystem::path& folder, RobotProfile& profile, const Clock& clock,
                            Monitor& monitor);

}  // namespace cairn::app
