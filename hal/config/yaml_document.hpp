// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/yaml.h>

#include <string_view>

namespace cairn {

/// The one YAML document of a text. Null when the text is empty. Throws YAML::ParserException when the text is not
/// YAML, or when a second document begins. (YAML::LoadAll would never return from a text such as ",".) The caller is a
/// .cpp file that turns the exception into an Error.
[[nodiscard]] YAML::Node parse_yaml_document(std::string_view text);

}  // namespace cairn
