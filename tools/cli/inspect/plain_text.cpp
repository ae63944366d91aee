// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/plain_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace cairn::cli {
namespace {

/// To a millionth, without zeros at the end; small numbers to six digits.
std::string rounded(double number) {
  if (number == 0) return "0";  // no sign
  if (std::abs(number) < 1e-3) return fmt::format("{:.6g}", number);
  std::string text = fmt::format("{:.6f}", number);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

/// "points_per_scan": 3 → "points per scan: 3", nested values indented below.
void write_plain(std::string& out, const report::Json& value, const std::string& indent) {
  const auto scalar = [](const report::Json& v) {
    if (v.is_number_float()) return rounded(v.get<double>());
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
