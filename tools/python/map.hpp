// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::python {

/// A map as Python holds it. Nobody changes it any more.
struct Map {
  std::shared_ptr<const mapping::SemanticOcTree> tree;
  std::string metadata{};  ///< of a .cairn file; else empty
};

}  // namespace cairn::python
