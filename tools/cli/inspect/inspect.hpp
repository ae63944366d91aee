// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "hal/result.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {

struct InspectOptions {
  std::filesystem::path path{};
  std::string model{};                  ///< of a capture, instead of what its packets say
  std::filesystem::path out{};          ///< where to write one scan as PCD; empty: nowhere
  std::optional<std::uint64_t> scan{};  ///< which one, counted from 0; none: the first complete one
  std::string as{};                     ///< of a calibration: format of `out`, which is kalibr, ros or opencv
  std::optional<std::size_t> camera{};  ///< of a calibration: which camera goes to `out`; none: the first one, or all
  bool unfinished_is_damage = true;  ///< `damage` tells, too, that a recording was not closed; `unfinished` always does
};

/// What is in the folder of a recording, of a run or of several, one of a recording's files (candump, gpio.csv, a list
/// of pictures), a capture (pcap, pcapng), a picture (PNG, JPEG, TIFF), an array (.npy), a sweep (.bin), a map (.cairn,
/// .ot, .bt), a trajectory (.tum, .txt), a point cloud (.pcd) or a calibration of cameras (.yaml, .yml). Damage that
/// leaves something to tell is told in `damage`, not as an Error.
[[nodiscard]] Result<report::Json> inspect(const InspectOptions& options);

}  // namespace cairn::cli
