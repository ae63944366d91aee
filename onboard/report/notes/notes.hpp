// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "onboard/report/figures/run_report.hpp"

namespace cairn::report {

/// How much a note matters.
enum class Severity : std::uint8_t {
  kWarning,  ///< the result holds, with a reserve
  kError,    ///< the result, or a part of it, is not to be relied on
};
/// "warning" or "error", as in report.json.
[[nodiscard]] std::string_view to_string(Severity severity);

/// Something that a reader of the results must know.
struct Note {
  Severity severity{};
  std::string text;    ///< one or two sentences
  std::string remedy;  ///< what to do; empty: nothing can be done
};

/// All that a reader of the results must know, errors first. report.json, report.html and the console show the same.
/// Empty: nothing was lost, late or unsure.
[[nodiscard]] std::vector<Note> notes_of(const RunReport& report);

}  // namespace cairn::report
