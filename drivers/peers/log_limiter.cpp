// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/log_limiter.hpp"

#include <algorithm>
#include <cctype>

namespace cairn::peer_link {
namespace {

constexpr std::size_t kNameBytes = 48, kReadBytes = 512;

/// One printable line of bounded length.
std::string clean(std::string_view line) {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
  std::string text(line.substr(0, LogLimiter::kLongest));
  for (char& c : text) c = std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
  return text;
}

bool is_number(std::string_view word) {
  const auto hex = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  constexpr std::size_t kByte = 2;
  return std::ranges::any_of(word, digit) || (word.size() >= kByte && std::ranges::all_of(word, hex));
}

}  // namespace

std::string LogLimiter::kind_of(std::string_view line) {
  line = line.substr(0, kReadBytes);
  std::string name;
  for (std::size_t i = 0; i < line.size() && name.size() < kNameBytes;) {
    std::size_t end = i;
    while (end < line.size() && std::isalnum(static_cast<unsigned char>(line[end])) != 0) ++end;
    const std::string_view word = line.substr(i, end - i);
    if (word.empty()) {
      // Between numbers there is nothing that tells kinds apart.
      if (name.empty() || name.back() != '#') name += line[i];
      ++i;
      continue;
    }
    if (!is_number(word))
      name += word;
    else if (name.empty() || name.back() != '#')
      name += '#';
    i = end;
  }
  return name;
}

LogLimiter::Kind& LogLimiter::kind(std::string_view line) {
  const std::string name = kind_of(line);
  const auto known = std::ranges::find(kinds_, name, &Kind::name);
  if (known != kinds_.end()) return *known;
  if (kinds_.size() <= kKinds) kinds_.push_back({name, {}, 0});
  return kinds_.back();
}

void LogLimiter::add(Time now, std::string_view line, std::vector<std::string>& out) {
  settle(now, out);
  if (!running_) begun_ = now;
  running_ = true;
  Kind& of_line = kind(line);
  if (of_line.lines == 0) of_line.example = clean(line);
  if (++of_line.lines <= kLinesOfAKind) out.push_back(clean(line));
}

void LogLimiter::settle(Time now, std::vector<std::string>& out) {
  if (running_ && now - begun_ >= kPeriod) finish(out);
}

void LogLimiter::finish(std::vector<std::string>& out) {
  for (const Kind& kind : kinds_)
    if (kind.lines > kLinesOfAKind)
      out.push_back(std::to_string(kind.lines - kLinesOfAKind) + " more lines in a minute like: " + kind.example);
  kinds_.clear();
  running_ = false;
}

}  // namespace cairn::peer_link
