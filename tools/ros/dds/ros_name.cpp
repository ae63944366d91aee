// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/dds/ros_name.hpp"

#include <algorithm>

namespace cairn::ros {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

bool is_token(std::string_view text) {
  const auto fits = [](char c) { return is_letter(c) || is_digit(c); };
  return !text.empty() && !is_digit(text.front()) && std::ranges::all_of(text, fits) &&
         text.find("__") == text.npos;  // ROS keeps these for itself
}

}  // namespace

std::string namespace_fault(std::string_view text) {
  constexpr std::size_t kMost = 128;
  bool good = text.size() <= kMost;
  for (std::string_view rest = text; good;) {
    const std::size_t slash = rest.find('/');
    good = is_token(rest.substr(0, slash));
    if (slash == rest.npos) break;
    rest.remove_prefix(slash + 1);
  }
  if (good) return {};
  return '"' + std::string(text) + "\" is no namespace of ROS; write letters, digits and single _, such as husky_1";
}

std::string namespace_of(std::string_view robot) {
  std::string name;
  for (const char c : robot) {
    const char letter = is_letter(c) || is_digit(c) ? c : '_';
    if (letter != '_' || !name.ends_with('_')) name += letter;
  }
  if (name.empty()) return "robot";
  return is_digit(name.front()) ? "robot_" + name : name;
}

std::string dds_topic_of(std::string_view ros_topic) { return "rt" + std::string(ros_topic); }

}  // namespace cairn::ros
