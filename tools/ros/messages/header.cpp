// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/header.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace cairn::ros {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

}  // namespace

Stamp stamp_of(Time time, Duration utc_offset) {
  constexpr std::int64_t kLast = (std::int64_t{std::numeric_limits<std::int32_t>::max()} + 1) * kSecond - 1;
  std::int64_t sum = 0;
  const std::int64_t robot = time.time_since_epoch().count();
  if (__builtin_add_overflow(robot, utc_offset.count(), &sum)) sum = robot < 0 ? 0 : kLast;
  const std::int64_t ns = std::clamp<std::int64_t>(sum, 0, kLast);
  return {.sec = static_cast<std::int32_t>(ns / kSecond), .nanosec = static_cast<std::uint32_t>(ns % kSecond)};
}

Duration utc_of(const Stamp& stamp) { return Duration{stamp.sec * kSecond + stamp.nanosec}; }

Header header_of(Time time, Duration utc_offset, std::string_view frame, Arena& arena) {
  return {.stamp = stamp_of(time, utc_offset), .frame_id = arena.text(frame)};
}

}  // namespace cairn::ros
