// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/write_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "hal/files/file.hpp"
#include "onboard/report/json/report_json.hpp"
#include "onboard/report/page/report_html.hpp"
#include "tests/onboard/report/sample_report.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::report {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  const auto bytes = read_file(path, 1 << 26);
  return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "";
}

TEST(WriteReport, LeavesBothFilesAndTheSameOnesEveryTime) {
  const support::TemporaryFolder folder;
  const auto run = sample_run(50);
  ASSERT_TRUE(write_report(run->report, folder.path()).has_value());
  EXPECT_EQ(content(folder / "report.json"), to_text(to_json(run->report)));
  const std::string page = content(folder / "report.html");
  EXPECT_EQ(page, to_html(sample_run(50)->report).value());
  EXPECT_GT(page.size(), 10'000U);
}

TEST(WriteReport, IntoAMissingFolderIsAnErrorThatNamesIt) {
  const auto written = write_report(sample_run(5)->report, "/nowhere/at/all");
  ASSERT_FALSE(written.has_value());
  EXPECT_THAT(to_string(written.error()), testing::HasSubstr("/nowhere/at/all"));
}

TEST(PeakRss, IsMoreThanNothing) { EXPECT_GT(peak_rss_mb(), 1); }

}  // namespace
}  // namespace cairn::report
