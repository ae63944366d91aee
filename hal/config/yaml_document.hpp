// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/yaml.h>

#include <string_view>

namespace cairn {

/// The one YAML document of a text; Null when the text is empty. Throws YAML::ParserException where the text is not
/// YAML or where a second document begins: nobody would read it. (YAML::LoadAll would never return from a text such as
/// ",".) For .cpp files that turn YAML into something of ours, and its exceptions into an Error.
[[nodiscard]] YAML::Node parse_yaml_document(std::string_view text);

}  // namespace cairn
