// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace cairn::vm {

/// The USB descriptor that GET_DESCRIPTOR's wValue names (type in the upper byte, index in the lower) of a UVC 1.0
/// camera with one bulk streaming endpoint and kModes as its formats; nothing where it has none.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> descriptor(std::uint16_t value);

}  // namespace cairn::vm
