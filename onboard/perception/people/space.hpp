// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace cairn::people {

/// What the map knew of a point's place before the scan came.
enum class Space : std::uint8_t {
  kUnknown,  ///< nothing, or too little
  kFree,     ///< rays have gone through: who is there now has come
  kNew,      ///< something has been there for some scans
  kSettled,  ///< something has long stood there
};

}  // namespace cairn::people
