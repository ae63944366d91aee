// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/clients/messages/record.hpp"
#include "hal/drive.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::clients {

/// What the robot may do. As safety::Mode.
enum class RobotMode : std::uint8_t {
  kNormal,    ///< commands are executed
  kDegraded,  ///< commands are executed, below a speed cap
  kHold,      ///< zero is commanded, the drive stays enabled; ends with its cause
  kStop,      ///< zero is commanded and the drive is disabled; only arming ends it
};
[[nodiscard]] std::string_view to_string(RobotMode mode);
/// "normal", "hold" or "stop".
[[nodiscard]] std::string_view to_string(DriveLevel level);

/// How the robot is: sent with every change and once a second.
struct StateMessage {
  static constexpr RecordKind kKind = RecordKind::kState;
  static constexpr std::size_t kMaxText = 48, kMaxFaults = 32;

  Time stamp{};
  RobotMode mode = RobotMode::kStop;
  std::string cause;                 ///< the code of the fault that the mode has; empty: none
  std::vector<std::string> faults;   ///< codes of what is wrong now, as in docs/faults.md
  std::uint32_t arming_epoch = 0;    ///< to be given with a request to arm
  std::optional<DriveStatus> drive;  ///< none: the robot has no drive, or it has said nothing yet
  std::string shed;                  ///< work that is left out under overload
  std::uint64_t scans = 0;           ///< so far
  std::uint32_t map_epoch = 0;       ///< of the last pose; see PoseMessage
  /// Where odom lies in the frame of the team's map, by now. None: in no team, or not known yet.
  std::optional<SE3> T_team_odom{};
};

/// Appends the body. It is: stamp (8), mode (1), a drive is there (1), its level (1) and cause (1), its epoch (4),
/// arming epoch (4), map epoch (4), scans (8), cause (text), shed (text), number of faults (1), their codes (texts),
/// T_team_odom is known (1), and if so, T_team_odom (7 × 8).
void encode(const StateMessage& message, std::vector<std::byte>& out);
/// Error kMalformed.
[[nodiscard]] Result<StateMessage> decode_state(std::span<const std::byte> body);

}  // namespace cairn::clients
