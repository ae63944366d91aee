// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "onboard/report/figures/accuracy.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::report::html {

// Each returns one part of the page; empty if there is nothing to show.
[[nodiscard]] std::string header(const RunReport& report);
[[nodiscard]] std::string tiles(const RunReport& report, const Accuracy& accuracy);
/// The section "Worth a look": notes_of(report).
[[nodiscard]] std::string notes(const RunReport& report);
[[nodiscard]] std::string map_section(const RunReport& report, const std::string& svg);
[[nodiscard]] std::string accuracy_section(const RunReport& report, const Accuracy& accuracy);
[[nodiscard]] std::string timing_section(const RunReport& report);
[[nodiscard]] std::string schedule_section(const RunReport& report);
[[nodiscard]] std::string events_section(const RunReport& report);
[[nodiscard]] std::string peers_section(const RunReport& report);
[[nodiscard]] std::string details_section(const RunReport& report);

}  // namespace cairn::report::html
