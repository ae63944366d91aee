// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/state_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace cairn::app {

Result<StateLock> StateLock::take(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  const std::filesystem::path file = folder / "lock";
  StateLock lock(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0644));
  const auto reason = [] { return std::generic_category().message(errno); };
  if (lock.fd_ < 0) return Error{Errc::kIo, "the state folder cannot be locked", file.string(), {}, reason()};
  if (::flock(lock.fd_, LOCK_EX | LOCK_NB) == 0) return lock;
  if (errno != EWOULDBLOCK) return Error{Errc::kIo, "the state folder cannot be locked", file.string(), {}, reason()};
  return Error{Errc::kLimit,
               "another core uses this state folder",
               folder.string(),
               {},
               "stop that core, or give this one a --state of its own"};
}

StateLock::StateLock(StateLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

StateLock::~StateLock() {
  if (fd_ >= 0) ::close(fd_);
}

}  // namespace cairn::app
