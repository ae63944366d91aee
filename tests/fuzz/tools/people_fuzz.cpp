// SPDX-License-Identifier: Apache-2.0
// Any text as people.csv: what was read is in order, near, and each id occurs once at a time.
#include <cmath>
#include <set>
#include <string_view>

#include "tests/fuzz/require.hpp"
#include "tools/cli/evaluate/people_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  const auto rows = cli::parse_people({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!rows) return 0;
  std::set<std::int64_t> at_once;
  for (std::size_t i = 0; i < rows->size(); ++i) {
    const cli::PersonRow& row = (*rows)[i];
    require(i == 0 || (*rows)[i - 1].stamp <= row.stamp);
    if (i > 0 && (*rows)[i - 1].stamp != row.stamp) at_once.clear();
    require(at_once.insert(row.id).second);
    require(row.id >= 0 && row.position.allFinite());
    require(std::abs(to_seconds(row.stamp.time_since_epoch())) < 5e9);
  }
  return 0;
}
