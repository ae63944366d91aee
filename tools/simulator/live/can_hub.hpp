// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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
  static constexpr std::size_t kMaxClients = 8;

  /// Replaces a socket that no program serves any more. `clock` must outlive the hub. Errors: kInvalidConfig (no name
  /// of a bus), kIo (another program plays this bus, or the system refuses), each with the remedy.
  static Result<std::unique_ptr<CanHub>> open(const std::string& interface, const Clock& clock);
  CanHub(const CanHub&) = delete;
  CanHub& operator=(const CanHub&) = delete;
  ~CanHub() override;

  /// The next frame of a program, stamped when it was sent. Never waits, whatever the timeout. Errors: kMalformed (a
  /// program sent what is no frame), kLimit (kMaxClients are connected, and one more was turned away).
  Result<Poll> next(Packet& packet, Duration timeout) override;
  /// To all programs. kQueueFull: one of them had no room for it. kSent also where nobody is connected.
  drive::SendResult send(const drive::CanFrame& frame) override;
  Result<void> restart() override { return {}; }

  [[nodiscard]] std::size_t clients() const { return clients_.size(); }

 private:
  using Client = std::unique_ptr<drive::UnixCanLink>;

  CanHub(int fd, std::filesystem::path path, const Clock& clock) : fd_(fd), path_(std::move(path)), clock_(clock) {}
  Result<void> accept_clients();
  /// Whether `client` had a frame; it is then in `packet`, and the others have it.
  Result<bool> take_from(Client& client, Packet& packet);
  drive::SendResult pass_on(const drive::CanFrame& frame, const Client* from);
  void drop_lost();

  int fd_;
  std::filesystem::path path_;
  const Clock& clock_;
  std::vector<Client> clients_;
  std::size_t turn_ = 0;
};

}  // namespace cairn::simulator
