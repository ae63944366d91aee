// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/clients/messages/short_text.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

// What a client asks of the robot by command.sock, and what the robot answers.
namespace cairn::clients {

/// Who commands, for messages to others.
using ClientName = ShortText<32>;

/// Where the robot is, by somebody who knows. Height, roll and pitch are the robot's own.
struct Placement {
  /// The frame of a team's map, and the only name in `frame` that is no robot's.
  static constexpr std::string_view kTeam = "team";
  static constexpr double kFarthest_m = 100'000, kLeastSigma_m = 0.01, kMostSigma_m = 1000, kLeastSigma_rad = 0.001;

  ShortText<32> frame{};          ///< a teammate: its odom; kTeam; empty: the frame of the team's start poses
  double x = 0, y = 0;            ///< of base_link, metres
  double yaw = 0;                 ///< of base_link, rad
  double sigma_m = kMostSigma_m;  ///< of x and of y; with kMostSigma_m, what was said before is taken back
  double sigma_rad = 3.14;        ///< of yaw

  [[nodiscard]] bool possible() const;
  [[nodiscard]] bool takes_back() const { return sigma_m == kMostSigma_m; }
  friend bool operator==(const Placement&, const Placement&) = default;
};

/// One request.
struct Command {
  enum class Verb : std::uint8_t {
    kVelocity = 1,  ///< move at v and w, for valid_for
    kHold = 2,      ///< stand still; the motors stay enabled
    kArm = 3,       ///< end the stop of this epoch
    kDisarm = 4,    ///< stop and disable the motors, until kArm
    kStop = 5,      ///< the same from anybody, without the lease
    kRelease = 6,   ///< give the lease back
    kPlace = 7,     ///< tell the team where the robot is, without the lease
  };
  /// No velocity is valid for longer: a commander that is gone must not move the robot.
  static constexpr Duration kMostValid = std::chrono::milliseconds(200);

  Verb verb = Verb::kHold;
  std::uint32_t number = 0;  ///< counts up in one connection; the answer repeats it
  Time sent{};               ///< of this machine's monotonic clock
  Duration valid_for{};      ///< of a velocity, from `sent` on: above 0, at most kMostValid
  double v = 0, w = 0;       ///< m/s forward, rad/s to the left, of base_link
  std::uint32_t epoch = 0;   ///< for kArm: of the stop that it ends, as the last answer said
  ClientName who;
  Placement place{};  ///< for kPlace

  friend bool operator==(const Command&, const Command&) = default;
};
[[nodiscard]] std::string_view to_string(Command::Verb verb);

/// What became of a command.
struct Answer {
  enum class Outcome : std::uint8_t {
    kDone = 1,       ///< as asked
    kLimited = 2,    ///< slower than asked: `v` and `w` say how much
    kHeld = 3,       ///< the robot does not move now: `why`
    kNotHolder = 4,  ///< another client commands: `holder`
    kStale = 5,      ///< sent too long ago, or after a later one
    kInvalid = 6,    ///< no number, or valid for too long
    kRefused = 7,    ///< cannot be armed, or placed: `why`
    kReplaced = 8,   ///< a later command came before this one was used
  };
  Outcome outcome = Outcome::kDone;
  std::uint32_t number = 0;  ///< of the command; 0: nobody asked
  std::uint32_t epoch = 0;   ///< to be given with kArm
  bool stopped = true;       ///< only kArm lets the robot move
  double v = 0, w = 0;       ///< what the drive was told
  ClientName holder;         ///< who commands now; empty: nobody
  ShortText<200> why;        ///< empty: all is as asked

  friend bool operator==(const Answer&, const Answer&) = default;
};
[[nodiscard]] std::string_view to_string(Answer::Outcome outcome);

/// Writes a whole record into `out`, whose memory is reused.
void encode(const Command& command, std::vector<std::byte>& out);
/// Errors: those of decode_record(); kMalformed (not a command, an unknown verb, more bytes than it has).
[[nodiscard]] Result<Command> decode_command(std::span<const std::byte> message);

/// A greeting is the answer that nobody asked for: each client gets it first.
void encode(const Answer& answer, std::uint32_t sequence, std::vector<std::byte>& out);
[[nodiscard]] Result<Answer> decode_answer(std::span<const std::byte> message);

}  // namespace cairn::clients
