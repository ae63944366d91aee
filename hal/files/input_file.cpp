// SPDX-License-Identifier: Apache-2.0
#include "hal/files/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <system_error>

namespace cairn {
namespace {

Error io_error(std::string_view cause, const std::string& name, int error) {
  const Errc code = error == ENOENT ? Errc::kNotFound : Errc::kIo;
  return {code, cause, name, {}, std::generic_category().message(error)};
}

Error refusal(::mode_t mode, const std::string& name) {
  const auto is = [&](std::string_view cause, const char* remedy) {
    return Error{Errc::kUnsupported, cause, name, {}, remedy};
  };
  if (S_ISDIR(mode)) return is("this is a folder, not a file", "name a file in it");
  if (S_ISFIFO(mode)) return is("this is a pipe, not a file", "save what it carries in a file and name that");
  if (S_ISSOCK(mode)) return is("this is a socket, not a file", "save what it carries in a file and name that");
  return is("this is a device, not a file", "copy what it holds into a file and name that");
}

}  // namespace

Result<InputFile> InputFile::open(const std::filesystem::path& path) {
  const std::string name = path.string();
  struct stat info {};
  // Before it is opened: opening a device can already do something.
  if (::stat(path.c_str(), &info) != 0) return io_error("cannot open the file", name, errno);
  if (!S_ISREG(info.st_mode)) return refusal(info.st_mode, name);
  InputFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY), name);
  if (file.fd_ < 0) return io_error("cannot open the file", name, errno);
  // Somebody may have exchanged it meanwhile.
  if (::fstat(file.fd_, &info) != 0) return io_error("cannot look at the file", name, errno);
  if (!S_ISREG(info.st_mode)) return refusal(info.st_mode, name);
  file.size_ = static_cast<std::uint64_t>(info.st_size);
  return file;
}

InputFile& InputFile::operator=(InputFile&& other) noexcept {
  std::swap(fd_, other.fd_);
  size_ = other.size_;
  name_ = std::move(other.name_);
  return *this;
}

InputFile::~InputFile() {
  if (fd_ >= 0) ::close(fd_);
}

Result<std::size_t> InputFile::read(std::span<std::byte> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::read(fd_, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return io_error("cannot read the file", name_, errno);
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  return done;
}

Result<std::FILE*> InputFile::release_as_stream() {
  std::FILE* stream = ::fdopen(fd_, "rb");
  if (stream == nullptr) return io_error("cannot read the file", name_, errno);
  fd_ = -1;
  return stream;
}

Result<std::ifstream> open_input_stream(const std::filesystem::path& path) {
  const auto file = InputFile::open(path);
  if (!file) return file.error();
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return io_error("cannot open the file", path.string(), errno);
  return stream;
}

}  // namespace cairn
