// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "onboard/report/figures/pose_error.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::report::html {

/// What more than one section needs.
struct Figures {
  std::optional<TrajectoryError> error;  ///< none without ground truth
  std::vector<PoseError> pose_errors;
};

// Each returns one part of the page; empty if there is nothing to show.
[[nodiscard]] std::string header(const RunReport& report);
[[nodiscard]] std::string tiles(const RunReport& report, const Figures& figures);
/// The section "Worth a look": overruns, losses, covariances that are too small.
[[nodiscard]] std::string notes(const RunReport& report, const Figures& figures);
[[nodiscard]] std::string map_section(const RunReport& report, const std::string& svg);
[[nodiscard]] std::string accuracy_section(const RunReport& report, const Figures& figures);
[[nodiscard]] std::string timing_section(const RunReport& report);
[[nodiscard]] std::string schedule_section(const RunReport& report);
[[nodiscard]] std::string events_section(const RunReport& report);
[[nodiscard]] std::string peers_section(const RunReport& report);
[[nodiscard]] std::string details_section(const RunReport& report);

}  // namespace cairn::report::html
