// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/campaign.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string_view>

#include "hal/files/file.hpp"
#include "tests/support/places.hpp"

namespace cairn::faults {

// GoogleTest would print the bytes of a std::function.
void PrintTo(const Row& row, std::ostream* out) { *out << row.id << ", " << row.fault; }

namespace {

std::vector<Row> measured_rows() {
  std::vector<Row> rows;
  for (auto& group :
       {sensor_rows(), eye_rows(), odometry_rows(), garbage_rows(), drive_rows(), computer_rows(), peer_rows()})
    for (const Row& row : group)
      if (row.measure) rows.push_back(row);
  return rows;
}

const std::filesystem::path& document() {
  static const std::filesystem::path path = places::source() / "docs/faults.md";
  return path;
}

std::string text_of_document() {
  const auto bytes = read_file(document(), 1 << 20);
  EXPECT_TRUE(bytes) << to_string(bytes.error());
  return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : std::string();
}

constexpr const char* kRemedy = "write it anew with tools/ci/fault_table.sh";

class Campaign : public testing::TestWithParam<Row> {};

TEST_P(Campaign, EveryRowHolds) {
  const Row& row = GetParam();
  const Measured m = row.measure();
  EXPECT_EQ(m.worst, row.worst) << to_string(m.worst);
  EXPECT_TRUE(m.held) << row.requirement;
  EXPECT_EQ(m.detect.has_value(), row.detect_within > Duration{});
  EXPECT_TRUE(!m.detect || *m.detect <= row.detect_within) << to_milliseconds(*m.detect) << " ms";
  EXPECT_EQ(m.recover.has_value(), row.recover_within > Duration{});
  EXPECT_TRUE(!m.recover || *m.recover <= row.recover_within) << to_milliseconds(*m.recover) << " ms";
  EXPECT_NE(text_of_document().find("\n" + to_line(row, m)), std::string::npos) << kRemedy;
}

INSTANTIATE_TEST_SUITE_P(Faults, Campaign, testing::ValuesIn(measured_rows()),
                         [](const auto& row) { return row.param.id; });

TEST(FaultTable, IdsAreUniqueAndEveryRowNamesATestOrAReason) {
  std::set<std::string> ids;
  for (const auto& rows : {sensor_rows(), eye_rows(), odometry_rows(), garbage_rows(), drive_rows(), computer_rows(),
                           peer_rows(), rows_left_out()})
    for (const Row& row : rows) {
      EXPECT_TRUE(ids.insert(row.id).second) << row.id;
      EXPECT_TRUE(row.measure || !row.test.empty()) << row.id;
    }
}

/// That the figures of each measured row are its own, EveryRowHolds shows.
TEST(FaultTable, TheDocumentIsCurrent) {
  if (std::getenv("CAIRN_WRITE_FAULT_TABLE") != nullptr) {
    ASSERT_TRUE(write_file_atomic(document(), to_markdown([](const Row& row) { return to_line(row, row.measure()); })));
    return;
  }
  const std::string text = text_of_document();
  const auto line_in_document = [&text](const Row& row) {
    const std::size_t at = text.find("\n| " + row.id + " | ") + 1;
    return at == 0 ? "no line of " + row.id + "\n" : text.substr(at, text.find('\n', at) + 1 - at);
  };
  EXPECT_EQ(text, to_markdown(line_in_document)) << kRemedy;
}

}  // namespace
}  // namespace cairn::faults
