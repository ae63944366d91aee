// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/recording.hpp"

#include <algorithm>
#include <system_error>

#include "hal/files/file.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxYamlBytes = 256 * 1024;

}  // namespace

const char* path_fault(std::string_view file) {
  const auto is_odd = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F || c == '\\' || c == ','; };
  if (file.empty() || file.size() > 200) return "a file name must have 1 … 200 bytes";
  if (std::any_of(file.begin(), file.end(), is_odd)) return "a file name must not hold `\\`, `,` or control characters";
  const fs::path path(file);
  if (path.is_absolute()) return "a file must be named relative to the recording's folder";
  for (const fs::path& part : path)
    if (part.empty() || part == "." || part == "..") return "a file name must not hold `.` or `..` or end with `/`";
  return nullptr;
}

Result<fs::path> resolve_inside(const fs::path& dir, std::string_view file) {
  if (const char* fault = path_fault(file); fault != nullptr)
    return Error{Errc::kMalformed, "not a usable file name", std::string(file), {}, fault};
  const fs::path path = dir / file;
  std::error_code error;
  if (!fs::exists(path, error)) return Error{Errc::kNotFound, "the file is missing", path.string(), {}, {}};
  if (!fs::is_regular_file(path, error)) return Error{Errc::kIo, "not a regular file", path.string(), {}, {}};
  const fs::path folder = fs::canonical(dir, error), real = fs::canonical(path, error);
  if (error) return Error{Errc::kIo, "cannot resolve the file", path.string(), {}, error.message()};
  if (std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first != folder.end())
    return Error{Errc::kMalformed, "the file lies outside the recording", path.string(), {}, real.string()};
  return path;
}

namespace {

Error no_recording(const fs::path& dir) {
  std::error_code ignored;
  if (!fs::exists(dir, ignored)) return {Errc::kNotFound, "there is no such recording", dir.string()};
  const fs::path ending = dir.extension();
  if (!fs::is_directory(dir, ignored) && (ending == ".pcap" || ending == ".pcapng"))
    return {Errc::kMalformed,
            "this is a capture, not a recording",
            dir.string(),
            {},
            "make one of it: cairn import velodyne-pcap " + dir.string() + " --out recording"};
  if (!fs::is_directory(dir, ignored))
    return {Errc::kMalformed, "this is a file: a recording is a folder", dir.string(), {}, "`cairn inspect` reads it"};
  return {Errc::kNotFound,
          "not a recording: there is no recording.yaml",
          dir.string(),
          {},
          "`cairn inspect " + dir.string() + "` says what is there"};
}

}  // namespace

Result<Recording> load_recording(const fs::path& dir) {
  std::error_code ignored;
  if (!fs::is_directory(dir, ignored)) return no_recording(dir);
  const fs::path index = dir / kIndexFile;
  const auto bytes = read_file(index, kMaxYamlBytes);
  if (!bytes) return bytes.error().code == Errc::kNotFound ? no_recording(dir) : bytes.error();
  const auto check = [&](std::string_view file) -> std::optional<Error> {
    const auto path = resolve_inside(dir, file);
    return path ? std::nullopt : std::optional(path.error());
  };
  return parse_recording({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, index.string(), check);
}

Error unfinished_recording(const fs::path& dir) {
  return {
      Errc::kTruncated,
      "the recording was not closed: its program was killed, has no disk left, or still writes",
      dir.string(),
      {},
      "its last second may be missing; make it again, or a closed copy: cairn faults " + dir.string() + " --out COPY"};
}

Result<void> save_recording(const fs::path& dir, const Recording& recording) {
  const fs::path index = dir / kIndexFile;
  if (recording.start_utc_ns < 0 || recording.start_utc_ns > kMaxUtcNs)
    return Error{Errc::kMalformed, "the start time must lie in 1970 … 2043", index.string(), {}, {}};
  const std::string text = to_yaml(recording);
  if (auto checked = parse_recording(text, index.string()); !checked) return checked.error();
  return write_file_atomic(index, text);
}

}  // namespace cairn::recording
