// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

namespace cairn::report {

/// One line of a budget file: a field of report.json and how large it may be.
struct BudgetLimit {
  std::string field;  ///< "tasks.safety.response_p999_ms"
  double at_most = 0;
  int line = 0;      ///< in the file, from 1
  std::string file;  ///< as it was named
};

/// A limit and the value that the run measured; none where the run did not measure it, as one in virtual time does not
/// measure latencies. What was not measured was not kept.
struct BudgetVerdict {
  BudgetLimit limit;
  std::optional<double> measured;
  [[nodiscard]] bool kept() const { return measured && *measured <= limit.at_most; }
};

/// A budget file: a YAML mapping of report.json's fields, nested as there, to the largest value that is allowed. For
/// one class of machines, as its name says. Errors: all faults at once, with file and line (kInvalidConfig).
[[nodiscard]] Result<std::vector<BudgetLimit>> parse_budgets(std::string_view yaml, std::string_view file_name);
[[nodiscard]] Result<std::vector<BudgetLimit>> load_budgets(const std::filesystem::path& file);

/// Before a run: whether its report can have these fields. `expected` is a report with all that is known to be in it.
/// An empty object or null stands for anything. Error kInvalidConfig: all others at once, with file, line and the names
/// that would do.
[[nodiscard]] Result<void> check_fields(const std::vector<BudgetLimit>& limits, const nlohmann::ordered_json& expected);

/// Compares limits with a report. Error kInvalidConfig: fields that are missing in the report or are neither number nor
/// null, all at once. A limit that cannot be checked must not count as kept.
[[nodiscard]] Result<std::vector<BudgetVerdict>> check_budgets(const std::vector<BudgetLimit>& limits,
                                                               const nlohmann::ordered_json& report);
/// A table for people: field, limit, measured value, and kept, EXCEEDED or NOT MEASURED.
[[nodiscard]] std::string to_table(const std::vector<BudgetVerdict>& verdicts);
/// Nothing where every limit was kept; otherwise what was not, and what to do (kLimit).
[[nodiscard]] Result<void> all_kept(const std::vector<BudgetVerdict>& verdicts);

}  // namespace cairn::report
