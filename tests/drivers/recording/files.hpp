// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace cairn::recording::test {

namespace fs = std::filesystem;

/// A folder of this test case alone, removed at its end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("cairn_") + test->test_suite_name() + "_" + test->name() + "_XXXXXX";
    std::replace(name.begin(), name.end(), '/', '_');  // parametrised tests have names with slashes
    std::string pattern = (fs::temp_directory_path() / name).string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make the folder " + pattern);
    path_ = pattern;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { fs::remove_all(path_); }
  [[nodiscard]] const fs::path& path() const { return path_; }
  [[nodiscard]] fs::path operator/(const fs::path& name) const { return path_ / name; }

 private:
  fs::path path_;
};

inline std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline void spit(const fs::path& path, std::string_view text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

inline std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

inline std::vector<std::byte> to_bytes(std::string_view text) {
  const auto view = bytes_of(text);
  return {view.begin(), view.end()};
}

/// A folder of recorded data, which lies outside of the project; skip with missing() when it is not there.
inline fs::path data(const fs::path& name) {
  const char* given = std::getenv("CAIRN_DATA");
  return (given != nullptr ? fs::path(given) : fs::path(CAIRN_SOURCE_DIR) / "../shared/data") / name;
}
inline std::string missing(const fs::path& path) { return "the recorded data is not here: " + path.string(); }

}  // namespace cairn::recording::test
