// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>

#include "tests/support/places.hpp"

namespace cairn::support {

/// A folder of recorded data, which lies outside of the project; skip the test when it is not there.
inline std::filesystem::path recorded_data(const std::filesystem::path& name) {
  const char* given = std::getenv("CAIRN_DATA");
  return (given != nullptr ? std::filesystem::path(given) : places::source() / "../shared/data") / name;
}

}  // namespace cairn::support
