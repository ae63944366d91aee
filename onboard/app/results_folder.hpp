// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "hal/files/unfinished_folder.hpp"
#include "hal/result.hpp"

namespace cairn::app {

inline constexpr const char* kResultMap = "map.cairn";
/// The folder in the output folder that gets the results of a run without a scan, where there are earlier ones.
inline constexpr const char* kFailedRun = "failed-run";

/// Moves the results of a run into the folder `out`, over those of an earlier run; without a scan into kFailedRun,
/// where there is an earlier map. Returns where they are. Error kIo.
[[nodiscard]] Result<std::filesystem::path> put_in_place(const std::filesystem::path& out, UnfinishedFolder& unfinished,
                                                         std::uint64_t scans);
/// Leaves `unfinished` with the files that are whole, if there are any. Returns the error with their names.
[[nodiscard]] Error keep_incomplete(UnfinishedFolder& unfinished, Error error);

}  // namespace cairn::app
