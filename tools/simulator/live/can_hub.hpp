// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/drive/can/unix_can_link.hpp"

namespace cairn::simulator {

/// A CAN bus without a kernel's CAN: programs connect to a Unix socket (drive::UnixCanLink), and every frame of one
/// reaches all others and the owner of the hub. What is no frame is refused, and a program that does not read loses
/// frames. The owner waits for nobody.
class CanHub final : public drive::CanLink {
 public:
  struct Counters {
    std::uint64_t refused = 0;      ///< records that are no frame
    std::uint64_t not_taken = 0;    ///< frames that a program had no room for
    std::uint64_t turned_away = 0;  ///< programs: kMaxClients are connected
  };
  static constexpr std::size_t kMaxClients = 8;

  /// Replaces a socket that no program serves any more. `clock` must outlive the hub. Errors: kInvalidConfig (no name
  /// of a bus), kIo (another program plays this bus, or the system refuses), each with the remedy.
  static Result<std::unique_ptr<CanHub>> open(const std::string& interface, const Clock& clock);
  CanHub(const CanHub&) = delete;
  CanHub& operator=(const CanHub&) = delete;
  ~CanHub() override;

  /// The next frame of a program, stamped when it was sent. Never waits, whatever the timeout.
  Result<Poll> next(Packet& packet, Duration timeout) override;
  /// To all programs. kSent also where nobody is connected: so it is on a bus of which one is the only node that
  /// listens.
  drive::SendResult send(const drive::CanFrame& frame) override;
  Result<void> restart() override { return {}; }

  [[nodiscard]] std::size_t clients() const { return clients_.size(); }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  using Client = std::unique_ptr<drive::UnixCanLink>;

  CanHub(int fd, std::filesystem::path path, const Clock& clock) : fd_(fd), path_(std::move(path)), clock_(clock) {}
  void accept_clients();
  /// Whether `client` had a frame; it is then in `packet`, and the others have it.
  bool take_from(Client& client, Packet& packet);
  void pass_on(const drive::CanFrame& frame, const Client* from);
  void drop_lost();

  int fd_;
  std::filesystem::path path_;
  const Clock& clock_;
  std::vector<Client> clients_;
  std::size_t turn_ = 0;
  Counters counters_;
};

}  // namespace cairn::simulator
