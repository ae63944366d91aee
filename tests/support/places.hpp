// SPDX-License-Identifier: Apache-2.0
// Where this build's sources and programs are. CMake writes the definitions, so that no compile command holds a path of
// one checkout and the compiler's cache serves every other.
#pragma once

#include <filesystem>
#include <string_view>

namespace cairn::places {

/// The project's root.
std::filesystem::path source();

/// A program that was built: `program("cairn")`.
std::filesystem::path program(std::string_view name);

}  // namespace cairn::places
