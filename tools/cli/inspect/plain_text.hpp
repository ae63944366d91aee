// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {

/// A JSON object as indented text for people.
[[nodiscard]] std::string to_plain_text(const report::Json& json);

}  // namespace cairn::cli
