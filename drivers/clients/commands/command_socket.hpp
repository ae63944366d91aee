// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/clients/commands/answer_port.hpp"
#include "drivers/clients/sockets/local_server.hpp"
#include "hal/clock.hpp"
#include "hal/ports.hpp"
#include "hal/relaxed_counter.hpp"

namespace cairn::clients {

/// command.sock of a running core. It never waits, and allocates nothing after open(): the drive task reads it. A
/// client that sends anything but a command is dropped at once.
class CommandSocket final : public Source, public AnswerPort {
 public:
  static constexpr std::size_t kMostClients = 8;
  /// next() then says once that nothing is there: a flood must not hold the drive task.
  static constexpr int kMostInARow = 32;
  /// Whose members may command, where the system has this group.
  static constexpr const char* kGroup = "cairn-drive";

  /// Any thread may read these.
  struct Counters {
    RelaxedCounter commands, refused, joined, unanswered;
  };

  /// `clock` must outlive it. Errors: those of LocalServer::open().
  static Result<std::unique_ptr<CommandSocket>> open(const std::filesystem::path& path, SourceId id,
                                                     const Clock& clock);
  Result<Poll> next(Packet& packet, Duration timeout) override;
  bool answer(std::uint16_t client, const Answer& answer) override;
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  CommandSocket(LocalServer server, SourceId id, const Clock& clock);
  bool fill(const LocalServer::Received& received, Packet& packet);

  LocalServer server_;
  SourceId id_;
  const Clock& clock_;
  std::vector<std::byte> out_;
  std::uint64_t delivered_ = 0;
  std::uint32_t answers_ = 0;
  int in_a_row_ = 0;
  Counters counters_;
};

}  // namespace cairn::clients
