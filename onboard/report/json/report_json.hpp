// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "onboard/report/figures/map_error.hpp"
#include "onboard/report/figures/run_report.hpp"
#include "onboard/report/labels/label_measures.hpp"

namespace cairn::report {

/// Objects with their members in the order they are written down, so that a report reads from general to particular.
using Json = nlohmann::ordered_json;

/// Field names are fixed, because scripts rely on them: docs/api.md lists them. A value that is not known is null.
[[nodiscard]] Json to_json(const TrajectoryError& error);
[[nodiscard]] Json to_json(const MapSummary& map);
[[nodiscard]] Json to_json(const mapping::PositionFigures& figures);
[[nodiscard]] Json to_json(const MapComparison& comparison);
[[nodiscard]] Json to_json(const MapError& error);
[[nodiscard]] Json to_json(const LabelError& error);
/// The classes that there are, by name.
[[nodiscard]] Json to_json(const ClassCounts& counts);
/// The content of report.json.
[[nodiscard]] Json to_json(const RunReport& report);

/// Text of a JSON value. Bytes that are not UTF-8 are replaced: file names and messages may hold any.
[[nodiscard]] std::string to_text(const Json& json);

}  // namespace cairn::report
