// SPDX-License-Identifier: Apache-2.0
// A cloud read from any bytes has finite points and offsets within a sweep, and survives being written and read again.
#include <span>

#include "drivers/recording/formats/pcd_file.hpp"
#include "tests/fuzz/require.hpp"

using namespace cairn;
using namespace cairn::recording;

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const auto pcd = parse_pcd(std::as_bytes(std::span(data, size)), "fuzz");
  if (!pcd) return 0;
  for (std::size_t i = 0; i < pcd->cloud.size(); ++i) {
    require(pcd->cloud.xyz[i].allFinite());
    require(pcd->cloud.offset_ns[i] <= 2'000'000'000);
  }
  const auto again = parse_pcd(to_pcd(pcd->cloud), "written");
  require(again.has_value());
  require(again->cloud.xyz == pcd->cloud.xyz);
  require(again->cloud.intensity == pcd->cloud.intensity);
  require(again->cloud.ring == pcd->cloud.ring);
  return 0;
}
