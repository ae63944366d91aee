// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "hal/result.hpp"

namespace cairn::protocol {

/// Bytes of the messages about people that a robot of a team would have sent to one teammate: one
/// every half second, encoded as peers do, with the overhead of RTPS, UDP and IP. `run`: the folder
/// of a run, with people.csv and trajectory.tum. Errors: those of the disk; kMalformed.
[[nodiscard]] Result<std::uint64_t> told_state_bytes(const std::filesystem::path& run);

}  // namespace cairn::protocol
