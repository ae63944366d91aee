// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "hal/files/file.hpp"
#include "tests/support/places.hpp"

namespace cairn::drive::test {

/// Where recorded CAN traffic is, where there is any.
inline std::filesystem::path can_data(const std::string& name) {
  const char* data = std::getenv("CAIRN_DATA");
  const std::filesystem::path root =
      data != nullptr ? std::filesystem::path(data) : places::source() / "../shared/data";
  return root / "can" / name;
}

inline std::string read_text(const std::filesystem::path& path) {
  const auto bytes = read_file(path, 1 << 24).value();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace cairn::drive::test

#define SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << (path) << ": recorded data is missing"
