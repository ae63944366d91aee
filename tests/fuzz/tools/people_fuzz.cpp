// SPDX-License-Identifier: Apache-2.0
// Any text as people.csv and as answers.csv: what was read is in order, near, and each id occurs once at a time.
#include <cmath>
#include <set>
#include <string_view>

#include "tests/fuzz/require.hpp"
#include "tools/cli/evaluate/answer_file.hpp"
#include "tools/cli/evaluate/people_file.hpp"

namespace {

void check_answers(std::string_view text) {
  using namespace cairn;
  const auto rows = cli::parse_answers(text, "fuzz");
  if (!rows) return;
  for (const cli::AnswerRow& row : *rows) {
    require(row.position.allFinite() && row.score >= 0 && row.score <= 1 && row.distance_m >= 0);
    require(std::abs(to_seconds(row.stamp.time_since_epoch())) < 5e9);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  check_answers({reinterpret_cast<const char*>(data), size});
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
