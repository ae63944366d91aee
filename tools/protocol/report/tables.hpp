// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/protocol/methods/outcome.hpp"

namespace cairn::protocol {

/// A table for people: the first column is text, the others are numbers as text. Book numbers stand in parentheses.
struct Table {
  std::string title, note;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

[[nodiscard]] Table scenes_table(const Outcome& outcome);          ///< 4.2: sizes and overlaps
[[nodiscard]] Table success_table(const Outcome& outcome);         ///< Fig. 4.12
[[nodiscard]] Table errors_table(const Outcome& outcome);          ///< 4.3: degrees and metres
[[nodiscard]] Table success_errors_table(const Outcome& outcome);  ///< the same over successes
[[nodiscard]] Table times_table(const Outcome& outcome);           ///< 4.4
[[nodiscard]] Table entropies_table(const Outcome& outcome);       ///< 3.2 and 4.5
[[nodiscard]] Table edges_table(const Outcome& outcome);           ///< section 4.6.2: PMM level 1 against edge ICP
[[nodiscard]] Table overlap_table(const Outcome& outcome);         ///< Fig. 4.10
[[nodiscard]] Table rms_table(const Outcome& outcome);             ///< 5.2 and Fig. 5.13
[[nodiscard]] std::vector<Table> all_tables(const Outcome& outcome);

/// In columns, for a terminal.
[[nodiscard]] std::string to_text(const Table& table);
[[nodiscard]] std::string to_html(const Table& table);

}  // namespace cairn::protocol
