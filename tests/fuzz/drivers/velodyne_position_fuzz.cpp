// SPDX-License-Identifier: Apache-2.0
// Any bytes as a position packet and as an NMEA sentence: an answer, and times within their ranges.
#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "drivers/velodyne/nmea.hpp"
#include "drivers/velodyne/position_packet.hpp"

namespace {

void check(std::string_view text) {
  const auto nmea = cairn::velodyne::parse_nmea(text);
  if (!nmea) return;
  constexpr std::int64_t kDay = 86'400'000'000, kLeapSecond = 1'000'000, kYear1980 = 315'532'800'000'000,
                         kYear2080 = 3'471'292'800'000'000;
  const bool sound = nmea->time_of_day_us >= 0 && nmea->time_of_day_us < kDay + kLeapSecond &&
                     (!nmea->utc_us || (*nmea->utc_us >= kYear1980 && *nmea->utc_us < kYear2080 + kLeapSecond));
  if (!sound) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  check({reinterpret_cast<const char*>(data), size});
  std::vector<std::byte> packet(cairn::velodyne::kPositionBytes);
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  std::copy_n(bytes, std::min(size, packet.size()), packet.begin());
  const auto position = cairn::velodyne::parse_position_packet(packet);
  if (position) check(position->nmea);
  if (cairn::velodyne::parse_position_packet({bytes, size}).has_value() && size != packet.size()) std::abort();
  return 0;
}
