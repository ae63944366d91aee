// SPDX-License-Identifier: Apache-2.0
#include "hal/files/append_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

namespace cairn {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{256} * 1024;

}  // namespace

AppendFile::AppendFile(int fd, std::filesystem::path path) : fd_(fd), path_(std::move(path)) {
  buffer_.reserve(kBufferBytes * 3 / 2);
}

AppendFile::AppendFile(AppendFile&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      path_(std::move(other.path_)),
      buffer_(std::move(other.buffer_)),
      record_ends_(std::move(other.record_ends_)),
      file_bytes_(other.file_bytes_),
      error_(other.error_) {}

AppendFile& AppendFile::operator=(AppendFile&& other) noexcept {
  if (this == &other) return *this;
  if (fd_ >= 0) static_cast<void>(close());
  fd_ = std::exchange(other.fd_, -1);
  path_ = std::move(other.path_);
  buffer_ = std::move(other.buffer_);
  record_ends_ = std::move(other.record_ends_);
  file_bytes_ = other.file_bytes_;
  error_ = other.error_;
  return *this;
}

AppendFile::~AppendFile() {
  if (fd_ >= 0) static_cast<void>(close());
}

Result<AppendFile> AppendFile::create(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd >= 0) return AppendFile(fd, path);
  return Error{Errc::kIo, "cannot create the file", path.string(), {}, std::generic_category().message(errno)};
}

Error AppendFile::fail(int error) {
  error_ = error;
  return Error{Errc::kIo, "cannot write the file", path_.string(), file_bytes_, std::generic_category().message(error)};
}

Error AppendFile::cut_back(std::size_t done, int error) {
  const auto after = std::upper_bound(record_ends_.begin(), record_ends_.end(), done);
  file_bytes_ += after == record_ends_.begin() ? 0 : *(after - 1);
  // What cannot be cut (a device) keeps half a record at its end; readers bear that.
  if (::ftruncate(fd_, static_cast<off_t>(file_bytes_)) != 0) return fail(error);
  return fail(error);
}

Result<void> AppendFile::end_record() {
  if (error_ != 0 || fd_ < 0) {
    buffer_.clear();  // whoever goes on writing must not fill the memory instead of the disk
    return fail(error_ != 0 ? error_ : EBADF);
  }
  record_ends_.push_back(buffer_.size());
  if (buffer_.size() >= kBufferBytes) return flush();
  return {};
}

Result<void> AppendFile::append_line(std::string_view line) {
  const auto bytes = std::as_bytes(std::span(line));
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  return end_record();
}

Result<void> AppendFile::flush() {
  if (error_ != 0 || fd_ < 0) return fail(error_ != 0 ? error_ : EBADF);
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t n = ::write(fd_, buffer_.data() + done, buffer_.size() - done);
    if (n < 0 && errno != EINTR) return cut_back(done, errno);
    done += n > 0 ? static_cast<std::size_t>(n) : 0;
  }
  file_bytes_ += done;
  buffer_.clear();
  record_ends_.clear();
  return {};
}

Result<void> AppendFile::close(bool sync) {
  if (fd_ < 0) return fail(EBADF);
  auto result = flush();
  // EINVAL: the file is a pipe or a device, which cannot be synced.
  if (result && sync && ::fsync(fd_) != 0 && errno != EINVAL) result = fail(errno);
  if (::close(std::exchange(fd_, -1)) != 0 && result) result = fail(errno);
  return result;
}

}  // namespace cairn
