// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tools/cli/command.hpp"

namespace cairn::cli {

/// What a command said and how it ended.
struct Outcome {
  int exit_code;
  std::string out, err;
  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(out, nullptr, false); }
};

/// Parses the arguments as main() does and runs the job, with stdout and stderr caught.
inline Outcome run(void (*add)(Commands&), std::vector<std::string> arguments) {
  CLI::App app;
  Commands commands{app, {}};
  add(commands);
  std::ostringstream out, err;
  std::streambuf* const old_out = std::cout.rdbuf(out.rdbuf());
  std::streambuf* const old_err = std::cerr.rdbuf(err.rdbuf());
  int code = kWrongArguments;
  try {
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
    app.parse(arguments);
    code = commands.job();
  } catch (const CLI::ParseError& e) {
    err << e.what();
  }
  std::cout.rdbuf(old_out);
  std::cerr.rdbuf(old_err);
  return {code, out.str(), err.str()};
}

/// A folder of its own for one test, gone afterwards.
class Folder {
 public:
  Folder() : path_(std::filesystem::path(testing::TempDir()) / name()) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }
  [[nodiscard]] std::string operator/(const std::string& file) const { return (path_ / file).string(); }
  [[nodiscard]] std::string text() const { return path_.string(); }

 private:
  static std::string name() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    return std::string("cairn_") + test.test_suite_name() + "_" + test.name();
  }
  std::filesystem::path path_;
};

}  // namespace cairn::cli
