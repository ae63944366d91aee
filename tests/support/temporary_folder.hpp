// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace cairn::support {

/// A new folder for one test, or for one suite, named after it and removed at its end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / (name() + "_XXXXXX")).string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make the folder " + pattern);
    path_ = pattern;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

 private:
  static std::string name() {
    const auto& running = *::testing::UnitTest::GetInstance();
    std::string name = std::string("cairn_") + running.current_test_suite()->name();
    if (const auto* test = running.current_test_info()) name += std::string("_") + test->name();
    std::replace(name.begin(), name.end(), '/', '_');  // parametrised tests have names with slashes
    return name;
  }

  std::filesystem::path path_;
};

}  // namespace cairn::support
