// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "tools/cli/evaluate/people_file.hpp"
#include "tools/cli/evaluate/people_scene.hpp"

namespace cairn::cli {

/// The way of each person, from people.csv.
class Ways {
 public:
  explicit Ways(std::span<const PersonRow> rows);

  /// Everybody who is known around `t`, by id.
  [[nodiscard]] std::vector<PeopleScan::Person> at(Time t) const;

 private:
  std::map<std::int64_t, std::vector<PersonRow>> ways_;
};

}  // namespace cairn::cli
