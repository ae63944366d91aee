// SPDX-License-Identifier: Apache-2.0
#include "hal/files/file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

#include "hal/files/input_file.hpp"

namespace cairn {
namespace {

namespace fs = std::filesystem;

Error io_error(std::string_view cause, const fs::path& path, int error) {
  const Errc code = error == ENOENT ? Errc::kNotFound : Errc::kIo;
  return {code, cause, path.string(), {}, std::generic_category().message(error)};
}

/// Owns a file descriptor.
class Fd {
 public:
  Fd(FileCalls& calls, int fd) : calls_(calls), fd_(fd) {}
  Fd(const Fd&) = delete;
  Fd& operator=(const Fd&) = delete;
  ~Fd() {
    if (fd_ >= 0) calls_.close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }

 private:
  FileCalls& calls_;
  int fd_;
};

int write_all(FileCalls& calls, int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = calls.write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    if (n == 0) return EIO;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return 0;
}

enum class Sync : bool { kNo, kYes };

int write_new(FileCalls& calls, const fs::path& path, std::span<const std::byte> bytes, Sync sync) {
  const Fd fd(calls, calls.open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (fd.get() < 0) return errno;
  if (const int error = write_all(calls, fd.get(), bytes); error != 0) return error;
  return sync == Sync::kNo || calls.fsync(fd.get()) == 0 ? 0 : errno;
}

Result<void> replace(FileCalls& calls, const fs::path& path, std::span<const std::byte> bytes, Sync sync) {
  fs::path temporary = path;
  temporary += ".tmp";
  if (const int error = write_new(calls, temporary, bytes, sync); error != 0) {
    calls.unlink(temporary.c_str());
    return io_error("cannot write the file", path, error);
  }
  if (calls.rename(temporary.c_str(), path.c_str()) == 0) return {};
  const int error = errno;
  calls.unlink(temporary.c_str());
  return io_error("cannot replace the file", path, error);
}

int sync_folder(FileCalls& calls, const fs::path& folder) {
  const Fd fd(calls, calls.open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC, 0));
  if (fd.get() < 0) return errno;
  return calls.fsync(fd.get()) == 0 ? 0 : errno;
}

}  // namespace

int FileCalls::open(const char* path, int flags, ::mode_t mode) { return ::open(path, flags, mode); }
::ssize_t FileCalls::write(int fd, const void* bytes, std::size_t size) { return ::write(fd, bytes, size); }
int FileCalls::fsync(int fd) { return ::fsync(fd); }
int FileCalls::close(int fd) { return ::close(fd); }
int FileCalls::rename(const char* from, const char* to) { return ::rename(from, to); }
int FileCalls::unlink(const char* path) { return ::unlink(path); }

FileCalls& FileCalls::machine() {
  static FileCalls calls;
  return calls;
}

Result<std::vector<std::byte>> read_file(const fs::path& path, std::uint64_t max_bytes) {
  auto file = InputFile::open(path);
  if (!file) return file.error();
  if (file->size() > max_bytes)
    return Error{Errc::kLimit,
                 "the file is too large",
                 path.string(),
                 {},
                 std::to_string(file->size()) + " bytes, at most " + std::to_string(max_bytes) + " are read"};
  std::vector<std::byte> bytes(static_cast<std::size_t>(file->size()));
  const auto read = file->read(bytes);
  if (!read) return read.error();
  bytes.resize(*read);
  return bytes;
}

Result<void> write_file_atomic(const fs::path& path, std::span<const std::byte> bytes, FileCalls& calls) {
  if (auto replaced = replace(calls, path, bytes, Sync::kYes); !replaced) return replaced;
  if (const int error = sync_folder(calls, path.parent_path()); error != 0)
    return io_error("cannot sync the folder of the file", path, error);
  return {};
}

Result<void> replace_file(const fs::path& path, std::span<const std::byte> bytes, FileCalls& calls) {
  return replace(calls, path, bytes, Sync::kNo);
}

Result<void> write_file_atomic(const fs::path& path, std::string_view text) {
  return write_file_atomic(path, std::as_bytes(std::span(text)));
}

}  // namespace cairn
