// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tools/protocol/report/claims.hpp"

namespace cairn::protocol {

// Parts of the pages. Titles, claims and captions are escaped; `figures`, `below` and `lead` are HTML.

/// Up to and including the header. `lead`: what stands below the title.
[[nodiscard]] std::string page_head(const std::string& window_title, const std::string& title, const std::string& lead);
/// `footer` ends the page.
[[nodiscard]] std::string page_end(const std::string& footer);

[[nodiscard]] std::string figure(const std::string& title, const std::string& inside);
/// A PNG picture that is part of the page.
[[nodiscard]] std::string picture(const std::string& title, std::span<const std::byte> png);
[[nodiscard]] std::string charts_section(const std::string& title, const std::string& figures,
                                         const std::string& below = "");
/// Empty without claims.
[[nodiscard]] std::string claims_section(const std::string& title, const std::vector<Claim>& claims);

/// "holds: …" or "does not hold: …" with the figures, a line each.
[[nodiscard]] std::string to_text(const std::vector<Claim>& claims);

}  // namespace cairn::protocol
