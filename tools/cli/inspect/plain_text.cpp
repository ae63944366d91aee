// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/plain_text.hpp"

#include <nlohmann/json.hpp>

namespace cairn::cli {
namespace {

/// "points_per_scan": 3 → "points per scan: 3", nested values indented below.
void write_plain(std::string& out, const report::Json& value, const std::string& indent) {
  const auto scalar = [](const report::Json& v) {
    return v.is_string() ? v.get<std::string>() : v.is_null() ? "none" : v.dump();
  };
  for (const auto& [key, v] : value.items()) {
    std::string label = value.is_array() ? "-" : key + ":";
    for (char& c : label) c = c == '_' ? ' ' : c;
    if (v.is_structured() && v.empty()) {
      out += indent + label + " none\n";
    } else if (v.is_structured()) {
      out += indent + label + "\n";
      write_plain(out, v, indent + "  ");
    } else {
      out += indent + label + " " + scalar(v) + "\n";
    }
  }
}

}  // namespace

std::string to_plain_text(const report::Json& json) {
  std::string out;
  write_plain(out, json, "");
  return out;
}

}  // namespace cairn::cli
