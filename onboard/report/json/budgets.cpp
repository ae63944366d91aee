// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/json/budgets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "hal/config/yaml_document.hpp"
#include "hal/files/file.hpp"

namespace cairn::report {
namespace {

constexpr std::uint64_t kMaxBytes = 1U << 20U;
constexpr int kMaxDepth = 8;

/// Walks a budget file, collecting limits and faults.
class BudgetReader {
 public:
  explicit BudgetReader(std::string_view file) : file_(file) {}

  void group(const YAML::Node& node, const std::string& prefix, int depth) {
    if (!node.IsMap() || depth > kMaxDepth) return fault(node, prefix, "must be a mapping of fields to limits");
    for (const auto& entry : node) {
      if (!entry.first.IsScalar()) {
        fault(entry.first, prefix, "a field must be plain text");
        continue;
      }
      const std::string path = prefix.empty() ? entry.first.Scalar() : prefix + "." + entry.first.Scalar();
      if (entry.second.IsScalar())
        limit(entry.second, path);
      else
        group(entry.second, path, depth + 1);
    }
  }

  std::vector<BudgetLimit> limits;
  std::string faults;

 private:
  void limit(const YAML::Node& node, const std::string& path) {
    double value = 0;
    if (!YAML::convert<double>::decode(node, value) || !std::isfinite(value))
      return fault(node, path, "a limit must be a number");
    if (std::any_of(limits.begin(), limits.end(), [&](const BudgetLimit& l) { return l.field == path; }))
      return fault(node, path, "is given twice");
    limits.push_back({path, value, node.Mark().line + 1, std::string(file_)});
  }
  void fault(const YAML::Node& node, const std::string& path, const char* what) {
    faults += fmt::format("{}:{}: {}: {}\n", file_, node.Mark().line + 1, path, what);
  }

  std::string_view file_;
};

/// Null where the report has no such field.
const nlohmann::ordered_json* find(const nlohmann::ordered_json& report, std::string_view path) {
  const nlohmann::ordered_json* at = &report;
  while (!path.empty()) {
    if (!at->is_object()) return nullptr;
    const std::size_t dot = std::min(path.find('.'), path.size());
    const auto found = at->find(std::string(path.substr(0, dot)));
    if (found == at->end()) return nullptr;
    at = &*found;
    path.remove_prefix(std::min(dot + 1, path.size()));
  }
  return at;
}

std::string names_in(const nlohmann::ordered_json& object) {
  std::string names;
  for (const auto& [name, value] : object.items()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

/// Why a report like `expected` cannot have a number at `path`; empty: it can.
std::string why_never(const nlohmann::ordered_json& expected, std::string_view path) {
  const nlohmann::ordered_json* at = &expected;
  while (!path.empty()) {
    if (at->is_null() || (at->is_object() && at->empty())) return {};
    if (!at->is_object()) return "no such number in report.json";
    const std::string key(path.substr(0, path.find('.')));
    const auto found = at->find(key);
    if (found == at->end()) return fmt::format("report.json has no {} there; it has {}", key, names_in(*at));
    at = &*found;
    path.remove_prefix(std::min(key.size() + 1, path.size()));
  }
  return at->is_number() || at->is_null() ? "" : "is no number in report.json";
}

std::string row(const BudgetVerdict& v, std::size_t width) {
  const std::string measured = v.measured ? fmt::format("{:.6g}", *v.measured) : "-";
  const char* verdict = !v.measured ? "NOT MEASURED" : v.kept() ? "kept" : "EXCEEDED";
  return fmt::format("{:<{}}  {:>12.6g}  {:>12}  {}\n", v.limit.field, width, v.limit.at_most, measured, verdict);
}

}  // namespace

Result<std::vector<BudgetLimit>> parse_budgets(std::string_view yaml, std::string_view file_name) {
  BudgetReader reader(file_name);
  try {
    reader.group(parse_yaml_document(yaml), "", 0);
  } catch (const YAML::Exception& e) {
    reader.faults += fmt::format("{}:{}: {}\n", file_name, e.mark.line + 1, e.msg);
  }
  if (reader.faults.empty() && reader.limits.empty()) reader.faults = fmt::format("{}: holds no limit\n", file_name);
  if (!reader.faults.empty())
    return Error{Errc::kInvalidConfig, "the budgets are not usable", std::string(file_name), {}, "\n" + reader.faults};
  return std::move(reader.limits);
}

Result<std::vector<BudgetLimit>> load_budgets(const std::filesystem::path& file) {
  const auto bytes = read_file(file, kMaxBytes);
  if (!bytes && bytes.error().code == Errc::kNotFound)
    return Error{Errc::kInvalidConfig, "there is no such budget file", file.string()};
  if (!bytes) return bytes.error();
  return parse_budgets({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file.string());
}

Result<void> check_fields(const std::vector<BudgetLimit>& limits, const nlohmann::ordered_json& expected) {
  std::string faults;
  for (const BudgetLimit& limit : limits)
    if (const std::string why = why_never(expected, limit.field); !why.empty())
      faults += fmt::format("{}:{}: {}: {}\n", limit.file, limit.line, limit.field, why);
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "the budgets name what no report has", {}, {}, "\n" + faults};
}

Result<std::vector<BudgetVerdict>> check_budgets(const std::vector<BudgetLimit>& limits,
                                                 const nlohmann::ordered_json& report) {
  std::vector<BudgetVerdict> verdicts;
  std::string faults;
  for (const BudgetLimit& limit : limits) {
    const nlohmann::ordered_json* figure = find(report, limit.field);
    if (figure != nullptr && figure->is_number())
      verdicts.push_back({limit, figure->get<double>()});
    else if (figure != nullptr && figure->is_null())
      verdicts.push_back({limit, std::nullopt});
    else
      faults += fmt::format("{}:{}: {}: no such number in report.json\n", limit.file, limit.line, limit.field);
  }
  if (!faults.empty())
    return Error{Errc::kInvalidConfig, "budgets that cannot be checked on this run", {}, {}, "\n" + faults};
  return verdicts;
}

std::string to_table(const std::vector<BudgetVerdict>& verdicts) {
  std::size_t width = 5;
  for (const BudgetVerdict& v : verdicts) width = std::max(width, v.limit.field.size());
  std::string table = fmt::format("{:<{}}  {:>12}  {:>12}\n", "field", width, "at most", "measured");
  for (const BudgetVerdict& v : verdicts) table += row(v, width);
  return table;
}

Result<void> all_kept(const std::vector<BudgetVerdict>& verdicts) {
  const auto missing = std::ranges::count_if(verdicts, [](const BudgetVerdict& v) { return !v.measured; });
  const auto exceeded = std::ranges::count_if(verdicts, [](const BudgetVerdict& v) { return v.measured && !v.kept(); });
  if (exceeded == 0 && missing == 0) return {};
  std::string detail = fmt::format("{} of {} exceeded, {} not measured", exceeded, verdicts.size(), missing);
  if (missing > 0)
    detail += "; latencies, overruns and allocations are measured by a run at --speed real of more than 2 s";
  return Error{Errc::kLimit, exceeded > 0 ? "budgets were exceeded" : "budgets were not measured", {}, {}, detail};
}

}  // namespace cairn::report
