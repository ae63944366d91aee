// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/clients/commands/command_socket.hpp"
#include "drivers/clients/messages/command.hpp"
#include "hal/drive.hpp"
#include "hal/packet.hpp"
#include "onboard/safety/failsafe.hpp"

namespace cairn::app {

/// Who may command the robot, and what is to be done now. One client at a time commands: the first that asks gets the
/// lease, and keeps it while it goes on asking. Anybody may stop the robot. Pure: packets and times in, orders and
/// answers out. It allocates nothing after construction.
class Commander {
 public:
  /// A holder that says nothing for so long has gone.
  static constexpr Duration kLease = std::chrono::seconds(1);
  /// The motors are given so long to become enabled before kArm is refused.
  static constexpr Duration kArming = std::chrono::seconds(3);
  /// Clocks of two processes on one machine are one clock. More than this ahead, it is another one.
  static constexpr Duration kAhead = std::chrono::milliseconds(5);

  /// How the robot is at this moment.
  struct Situation {
    Time now{};
    const safety::FailsafeDecision& decision;
    DriveStatus drive;
  };
  /// What a tick has to do, beside driving.
  struct Orders {
    bool stop = false;
    std::optional<std::uint32_t> arm;         ///< the epoch of the stop that is to end
    std::optional<clients::Placement> place;  ///< what the team is to be told
  };
  /// What one client is to be told.
  struct Reply {
    std::uint16_t client = 0;
    clients::Answer answer;
  };

  /// What the robot has that can be commanded.
  struct Abilities {
    bool drives = true;
    bool in_team = false;
  };

  explicit Commander(const Abilities& abilities);

  /// Takes one packet of the command socket. What cannot be a command is ignored.
  void take(const Packet& packet, const Situation& now);
  /// What the packets since the last call asked for.
  [[nodiscard]] Orders take_orders();
  /// Where the robot is to move. None: nobody has said so lately.
  [[nodiscard]] std::optional<DriveCommand> wanted(Time now) const;
  /// After the drive's tick; `told` is what it got. Replies to what was asked are due then.
  void conclude(const Situation& now, const DriveCommand& told);
  /// Since the last call of forget_replies().
  [[nodiscard]] std::span<const Reply> replies() const { return replies_; }
  void forget_replies() { replies_.clear(); }

 private:
  using Outcome = clients::Answer::Outcome;
  struct Known {
    std::uint16_t client = 0;  // 0: a free place
    std::uint32_t last_number = 0;
  };
  struct Holder {
    std::uint16_t client = 0;  // 0: nobody
    clients::ClientName name;
    Time heard{};
  };
  struct Asked {
    std::uint16_t client = 0;  // 0: nothing is asked
    clients::Command command;
    Time at{};
  };

  void join(std::uint16_t client, const Situation& now);
  void leave(std::uint16_t client);
  bool in_order(std::uint16_t client, std::uint32_t number);
  bool lease(std::uint16_t client, const clients::Command& command, Time now);
  void give_lease_back();
  void obey(std::uint16_t client, const clients::Command& command, const Situation& now);
  void take_velocity(std::uint16_t client, const clients::Command& command, const Situation& now);
  void take_arm(std::uint16_t client, const clients::Command& command, const Situation& now);
  void take_place(std::uint16_t client, const clients::Command& command, const Situation& now);
  void stop(std::uint16_t client, const clients::Command& command, const Situation& now);
  void conclude_arming(const Situation& now);
  void conclude_velocity(const Situation& now, const DriveCommand& told);
  clients::Answer* reply(std::uint16_t client, const clients::Command& command, Outcome outcome, const Situation& now);
  void refuse(std::uint16_t client, const clients::Command& command, Outcome outcome, std::string_view why,
              const Situation& now);

  Abilities abilities_;
  std::array<Known, clients::CommandSocket::kMostClients> known_{};
  Holder holder_;
  Orders orders_;
  DriveCommand velocity_;
  Time valid_until_ = Time::min();  // of velocity_
  std::optional<Time> said_;        // when it was last said how to move
  Asked arming_, moving_;
  std::vector<Reply> replies_;
};

}  // namespace cairn::app
