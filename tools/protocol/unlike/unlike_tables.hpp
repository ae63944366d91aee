// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "tools/protocol/report/claims.hpp"
#include "tools/protocol/report/tables.hpp"
#include "tools/protocol/unlike/unlike_outcome.hpp"

namespace cairn::protocol {

/// The times of Table 5.2: the first fusion of a scene, the middle one and the last. Null without
/// fusions.
[[nodiscard]] std::array<const UnlikeOutcome*, 3> three_times(const std::vector<const UnlikeOutcome*>& fusions);

[[nodiscard]] Table fused_table(const std::vector<UnlikeOutcome>& all);       ///< Table 7.5, by the book's rules
[[nodiscard]] Table shared_table(const std::vector<UnlikeOutcome>& all);      ///< over what both robots call occupied
[[nodiscard]] Table told_table(const std::vector<UnlikeOutcome>& all);        ///< as robots exchange maps
[[nodiscard]] Table label_rows_table();                                       ///< Tables 7.3 and 7.4
[[nodiscard]] Table unlike_rms_table(const std::vector<UnlikeOutcome>& all);  ///< Table 5.2
[[nodiscard]] Table fusions_table(const std::vector<UnlikeOutcome>& all);     ///< Figs. 5.13 and 5.14 as numbers
[[nodiscard]] std::vector<Table> unlike_tables(const std::vector<UnlikeOutcome>& all);  ///< all of them

/// What is asked of Cairn, and what the book says.
[[nodiscard]] std::vector<Claim> unlike_claims(const std::vector<UnlikeOutcome>& all);

}  // namespace cairn::protocol
