// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "drivers/peers/link_frame.hpp"
#include "hal/result.hpp"

namespace cairn::peer_link {

/// One end of the local socket (SOCK_SEQPACKET) between a core and its peer process. It never waits: frames that the
/// other end does not take in time are lost and counted. Either end may die and come back.
class LocalLink {
 public:
  /// What happened to the frames.
  struct Counters {
    std::uint64_t sent = 0, received = 0, lost = 0, refused = 0, connections = 0;
  };

  /// The core's end, which the other end connects to. The socket of a dead core is replaced. Errors: kInvalidConfig
  /// (the path is too long), kIo (another core serves it, or the system refused).
  static Result<LocalLink> listen(const std::filesystem::path& path);
  /// The peer process's end. It connects when it can, and again after the core has gone away.
  static LocalLink connect(std::filesystem::path path);
  LocalLink(const LocalLink&) = delete;
  LocalLink& operator=(const LocalLink&) = delete;
  LocalLink(LocalLink&& other) noexcept;
  LocalLink& operator=(LocalLink&&) = delete;
  ~LocalLink();

  /// Makes or takes a connection if there is none. True: there is one. The connection to an end that died lasts until
  /// receive() has read all that it sent.
  bool join();
  /// False if the frame was lost.
  bool send(const LinkFrame& frame);
  /// Takes the next frame, with its bytes in `memory`. False if there is none. Invalid frames are counted and skipped.
  [[nodiscard]] bool receive(std::vector<std::byte>& memory, LinkFrame& frame);
  /// Wait for it with poll(); −1 without a connection.
  [[nodiscard]] int readable_fd() const { return fd_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  LocalLink(std::filesystem::path path, int listener) : path_(std::move(path)), listener_(listener) {}
  void drop();

  std::filesystem::path path_;
  int listener_ = -1;  // the core's alone
  int fd_ = -1;
  std::vector<std::byte> out_;
  Counters counters_;
};

}  // namespace cairn::peer_link
