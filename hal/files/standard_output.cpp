// SPDX-License-Identifier: Apache-2.0
#include "hal/files/standard_output.hpp"

#include <cerrno>
#include <string>
#include <system_error>

namespace cairn {

Result<void> flush_output(std::FILE* out) {
  errno = 0;
  const bool flushed = std::fflush(out) == 0;
  const int error = errno;
  if (flushed && std::ferror(out) == 0) return {};
  const std::string why =
      error != 0 ? std::generic_category().message(error) : "an earlier part was not taken, is the disk full?";
  return Error{Errc::kIo, "cannot be written", "standard output", {}, why + "; what was printed is not complete"};
}

int end_of_program(std::string_view program, int code) {
  const auto flushed = flush_output(stdout);
  if (flushed) return code;
  const std::string text = to_string(flushed.error());
  std::fprintf(stderr, "%.*s: %s\n", static_cast<int>(program.size()), program.data(), text.c_str());
  return code != 0 ? code : 1;
}

}  // namespace cairn
