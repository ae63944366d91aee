// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cairn::app {

/// The name that was probably meant by `word`: the one that the fewest letters added, left out, replaced or swapped
/// make of it. None where more than a third of the letters are wrong. In words of up to four letters, one may be wrong,
/// and in longer ones at least two. Of equal ones the first.
[[nodiscard]] std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& names);

}  // namespace cairn::app
