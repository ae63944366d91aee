// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/file_lines.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace cairn::gpio {
namespace {

/// With the path and the remedy for the present errno, for whoever opens the lines.
Error explained(Error error, const std::string& path) {
  error.where = path;
  if (error.code == Errc::kMalformed) return error;
  error.detail = std::strerror(errno);
  if (error.code == Errc::kNotFound)
    error.detail += "; start the program that plays the robot first: cairn simulate --live";
  return error;
}

/// The level in the file; null: it is empty. O_NONBLOCK: what is no plain file must not hold the caller.
Result<std::optional<bool>> read_level(const std::string& path, Line line) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return line_lost("cannot read the GPIO line", line);
  char text = 0;
  const ssize_t size = ::read(fd, &text, 1);
  const int why = errno;
  ::close(fd);
  errno = why;
  if (size < 0) return line_lost("cannot read the GPIO line", line);
  if (size == 0) return std::optional<bool>();
  if (text == '0' || text == '1') return std::optional(text == '1');
  return Error{Errc::kMalformed, "a GPIO line's file holds 0 or 1", std::string(name_of(line)), {}, {}};
}

void wait(Duration time) {
  const timespec limit{0, time.count()};
  ppoll(nullptr, 0, &limit, nullptr);
}

}  // namespace

FileLines::FileLines(const Config& config, SourceId source, const Clock& clock)
    : GpioLines(source, clock), clock_(clock) {
  const std::filesystem::path folder = config.chip.substr(kFileChip.size());
  for (const LineUse& use : uses_of(config))
    if (!use.name.empty())
      files_.at(static_cast<std::size_t>(use.line)) = {
          .path = (folder / use.name).string(), .output = use.output, .active_low = use.active_low, .level = {}};
}

Result<std::unique_ptr<FileLines>> FileLines::open(const Config& config, SourceId source, const Clock& clock) {
  if (!is_file_chip(config.chip) || config.chip.size() == kFileChip.size())
    return Error{Errc::kInvalidConfig, "no folder of GPIO lines", config.chip, {}, "file:FOLDER is expected"};
  std::unique_ptr<FileLines> made(new FileLines(config, source, clock));
  for (std::size_t i = 0; i < kLines; ++i) {
    File& file = made->files_.at(i);
    if (file.path.empty()) continue;
    if (file.output) {
      if (auto low = made->set(static_cast<Line>(i), false); !low) return explained(low.error(), file.path);
      continue;
    }
    const auto level = made->level(static_cast<Line>(i));
    if (!level) return explained(level.error(), file.path);
    file.level = *level;
  }
  return made;
}

Result<Poll> FileLines::next(Packet& packet, Duration timeout) {
  for (Duration left = timeout; !look(packet); left -= kGlance) {
    if (left <= Duration::zero()) return Poll::kTimeout;
    wait(std::min(left, kGlance));
  }
  return Poll::kPacket;
}

bool FileLines::look(Packet& packet) {
  if (take_pulse(packet)) return true;
  for (std::size_t i = 0; i < kLines; ++i) {
    File& file = files_.at(i);
    if (file.path.empty() || file.output) continue;
    const auto level = this->level(static_cast<Line>(i));
    if (!level || *level == file.level) continue;  // level() tells of a line that is lost
    file.level = *level;
    fill(packet, {.line = static_cast<Line>(i), .level = *level}, clock_.now());
    return true;
  }
  return false;
}

Result<bool> FileLines::level(Line line) {
  const File& file = files_.at(static_cast<std::size_t>(line));
  if (file.path.empty()) return line_unused(line);
  const auto high = read_level(file.path, line);
  if (!high) return high.error();
  return *high && **high != file.active_low;
}

Result<void> FileLines::set(Line line, bool level) {
  const File& file = files_.at(static_cast<std::size_t>(line));
  if (file.path.empty()) return line_unused(line);
  const int fd = ::open(file.path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0644);
  if (fd < 0) return line_lost("cannot set the GPIO line", line);
  const char text = level != file.active_low ? '1' : '0';
  const bool written = ::write(fd, &text, 1) == 1;
  const int why = errno;
  ::close(fd);
  errno = why;
  if (!written) return line_lost("cannot set the GPIO line", line);
  return {};
}

}  // namespace cairn::gpio
