// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace cairn::python {

/// Tiles came, and the mirror of their map has taken them in.
struct MapChanged {
  std::string map;  ///< own or team
  std::size_t tiles = 0;
  bool caught_up = false;
};

}  // namespace cairn::python
