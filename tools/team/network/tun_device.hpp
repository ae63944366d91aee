// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "hal/result.hpp"

namespace cairn::team_run {

/// An open file, which is closed with its object.
class File {
 public:
  File() = default;
  explicit File(int fd) : fd_(fd) {}
  File(File&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  File& operator=(File&& other) noexcept;
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File();
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_ = -1;
};

/// A robot's network: a namespace of its own with a loopback and one TUN device, both up. It has no name, and ends with
/// its last file and process. So nothing is left behind, however a program dies.
struct TunNamespace {
  File network;  ///< the namespace, to be entered with setns()
  File packets;  ///< a read() takes an IP packet that the robot sent, a write() gives it one; neither waits
};

inline constexpr const char* kTunName = "radio0";

/// Makes a namespace, and leaves this thread in it. `address` is IPv4 in dots, of a net of 255.255.255.0. Errors: kIo;
/// `where` is the step that the system refused: kNoNamespace is the first.
inline constexpr const char* kNoNamespace = "a network namespace";
Result<TunNamespace> make_tun_namespace(const std::string& address);

/// Enters a user namespace in which this program may make networks. Its user stays. The program must have one thread.
Result<void> enter_user_namespace();

/// The network namespace of this thread.
Result<File> current_network();

}  // namespace cairn::team_run
