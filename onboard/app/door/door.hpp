// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/clients/commands/answer_port.hpp"
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

/// One input: a device or its recording, and the decoder of its bytes.
struct Input {
  recording::SourceEntry entry;
  std::unique_ptr<Source> source;
  std::unique_ptr<ScanDecoder> scans;      ///< null: it holds no scans
  drive::CanLink* can = nullptr;           ///< live: the same source, to send through
  gpio::GpioLines* lines = nullptr;        ///< live: the same source, to read levels from
  std::function<Losses()> losses;          ///< live: packets that the device lost; may be empty
  peer_link::PeerPort* peers = nullptr;    ///< live: the same source, to send through
  clients::AnswerPort* answers = nullptr;  ///< live: the same source, to answer commands through
};

/// Everything from outside enters through the door. The index of an input is its SourceId.
struct Door {
  std::vector<Input> inputs;
  recording::Recording recording;                  ///< the index of the recording that is played or made
  std::optional<scheduler::ScheduleLog> schedule;  ///< of the live run that made the recording
};

/// Which devices a live run opens besides those that geometry and safety use.
struct Devices {
  bool eyes = false;     ///< the camera tells the motion: it must not be missing
  bool camera = false;   ///< its pictures are looked at, or clients may have them
  bool thermal = false;  ///< the same
  bool depth = false;    ///< its clouds go into the map, or clients may have its pictures
  bool all = false;      ///< they are recorded
};

/// Opens the devices of the profile; they listen from now on. Decoders report events to `monitor`. `monitor` and
/// `clock` must outlive the door. Errors: kInvalidConfig (nothing could tell the motion, or fill the map), those of a
/// driver.
Result<Door> open_devices(const RobotProfile& profile, const Devices& which, const Clock& clock, Monitor& monitor);
/// Opens a recording. Its name, models and ports replace those of `profile`. An unfinished one is an event. A
/// source whose file cannot be opened returns that error once, and then ends. `monitor` must outlive the door. Errors:
/// those of the index.
Result<Door> open_recording(const std::filesystem::path& folder, RobotProfile& profile, Monitor& monitor);
/// Opens a recording whose sources behave like devices, for a live run: its packets arrive again, the first one in half
/// a second. `clock` and `monitor` must outlive the door. Errors: those of the index.
Result<Door> play_recording(const std::filesystem::path& folder, RobotProfile& profile, const Clock& clock,
                            Monitor& monitor);

/// Takes the sources of one kind out of the door: what they say now is something else than what was recorded.
void forget_recorded(recording::SensorKind kind, Door& door);

}  // namespace cairn::app
