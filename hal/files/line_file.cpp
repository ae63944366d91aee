// SPDX-License-Identifier: Apache-2.0
#include "hal/files/line_file.hpp"

#include <cerrno>
#include <cstring>

#include "hal/files/input_file.hpp"

namespace cairn {

Result<LineFile> LineFile::open(const std::filesystem::path& path, std::size_t max_line) {
  auto file = InputFile::open(path);
  if (!file) return file.error();
  const auto stream = file->release_as_stream();
  if (!stream) return stream.error();
  return LineFile(*stream, path.string(), max_line);
}

Result<std::optional<std::string_view>> LineFile::next() {
  text_.clear();
  std::size_t length = 0;
  int c = 0;
  while ((c = getc_unlocked(file_.get())) != EOF && c != '\n')
    if (++length <= max_line_) text_ += static_cast<char>(c);
  if (std::ferror(file_.get()) != 0) return Error{Errc::kIo, "cannot read", name_, {}, std::strerror(errno)};
  if (c == EOF && length == 0) return std::optional<std::string_view>();
  ++line_;
  if (length > max_line_) return at_line({Errc::kLimit, "the line is too long", {}, {}, {}});
  if (text_.ends_with('\r')) text_.pop_back();
  return std::optional<std::string_view>(text_);
}

Error LineFile::at_line(Error error) const {
  error.where = name_ + ":" + std::to_string(line_);
  return error;
}

}  // namespace cairn
