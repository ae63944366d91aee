// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/live_devices.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <optional>

#include "tests/support/temporary_folder.hpp"

namespace cairn::simulator {
namespace {

namespace fs = std::filesystem;

/// A variable of the environment, for one test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(LiveDevices, TheFolderIsTheUsersAlone) {
  const support::TemporaryFolder folder;
  const Variable run("XDG_RUNTIME_DIR", folder.path().string());
  const auto made = device_folder();
  ASSERT_TRUE(made);
  EXPECT_EQ(*made, folder / "cairn-live");
  EXPECT_EQ(fs::status(*made).permissions() & fs::perms::mask, fs::perms::owner_all);
  EXPECT_TRUE(device_folder()) << "it is there already";
  fs::remove(*made);
  fs::create_directory(folder / "elsewhere");
  fs::create_directory_symlink(folder / "elsewhere", *made);
  EXPECT_FALSE(device_folder()) << "a link may lead to somebody else's";
}

TEST(EStopFile, IsMadeReleasedAndRemoved) {
  const support::TemporaryFolder folder;
  const fs::path path = folder / "estop";
  {
    const auto estop = EStopFile::open(path);
    ASSERT_TRUE(estop);
    EXPECT_FALSE(estop->pressed());
    std::ofstream(path) << "0\n";
    EXPECT_TRUE(estop->pressed());
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(EStopFile, OneThatIsThereKeepsItsContentAndStays) {
  const support::TemporaryFolder folder;
  const fs::path path = folder / "estop";
  std::ofstream(path) << "0";
  {
    const auto estop = EStopFile::open(path);
    ASSERT_TRUE(estop);
    EXPECT_TRUE(estop->pressed());
  }
  EXPECT_TRUE(fs::exists(path));
  EXPECT_FALSE(EStopFile::open(folder.path())) << "a folder is no line";
  EXPECT_FALSE(EStopFile::open(folder / "missing/estop"));
}

TEST(LiveDevices, BusesThatCannotBeAreRefused) {
  const LiveClock clock;
  EXPECT_EQ(open_bus("unix:", clock).error().code, Errc::kInvalidConfig);
  EXPECT_FALSE(open_bus("no_such_can", clock));
}

}  // namespace
}  // namespace cairn::simulator
