// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>

#include "onboard/report/json/report_json.hpp"

namespace cairn::report {

/// null where there is no value.
template <class T>
[[nodiscard]] Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// The numbers of a matrix, row by row.
[[nodiscard]] inline Json numbers(const auto& values) {
  Json list = Json::array();
  for (Eigen::Index row = 0; row < values.rows(); ++row)
    for (Eigen::Index column = 0; column < values.cols(); ++column) list.push_back(values(row, column));
  return list;
}

}  // namespace cairn::report
