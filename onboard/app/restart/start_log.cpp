// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/start_log.hpp"

#include <charconv>
#include <span>
#include <string>
#include <vector>

#include "hal/files/file.hpp"

namespace cairn::app {
namespace {

constexpr std::uint64_t kMaxBytes = 4096;
constexpr std::size_t kKept = 10;

/// The stamps of this boot that lie in the window before `now`.
std::vector<Time> recent(std::string_view text, std::string_view boot, Time now) {
  std::vector<Time> starts;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    std::int64_t ns = 0;
    if (!line.starts_with(boot) || line.size() <= boot.size() || line[boot.size()] != ' ') continue;
    const char* end = line.data() + line.size();
    const auto read = std::from_chars(line.data() + boot.size() + 1, end, ns);
    const Time start{Duration{ns}};
    if (read.ec == std::errc{} && read.ptr == end && start <= now && start > now - StartLog::kWindow)
      starts.push_back(start);
  }
  return starts;
}

}  // namespace

bool StartLog::begin(Time now, std::string_view boot) {
  std::vector<Time> starts;
  if (const auto bytes = read_file(file_, kMaxBytes))
    starts = recent({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, boot, now);
  const bool too_many = starts.size() > static_cast<std::size_t>(kMaxStarts);
  starts.push_back(now);
  if (starts.size() > kKept) starts.erase(starts.begin(), starts.end() - kKept);
  std::string text;
  for (const Time t : starts) text += std::string(boot) + " " + std::to_string(t.time_since_epoch().count()) + "\n";
  (void)write_file_atomic(file_, std::as_bytes(std::span(text)), calls_);
  return too_many;
}

void StartLog::end() { calls_.unlink(file_.c_str()); }

}  // namespace cairn::app
