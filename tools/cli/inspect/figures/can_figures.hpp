// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>

#include "drivers/drive/agilex/agilex.hpp"
#include "tools/cli/inspect/figures/sensor_figures.hpp"

namespace cairn::cli {

/// What is on a CAN bus: identifiers with their counts and last bytes, error frames, and what an AgileX chassis said.
class CanFigures final : public SensorFigures {
 public:
  static constexpr std::size_t kMaxIds = 256;  ///< identifiers listed; further ones are only counted

  Result<const Scan*> take(const Packet& packet) override;
  [[nodiscard]] report::Json to_json() const override;

 private:
  struct PerId {
    std::uint64_t frames = 0;
    drive::CanFrame last;
  };
  void note_chassis(const drive::CanFrame& frame);

  std::map<std::uint32_t, PerId> ids_;
  std::uint64_t frames_ = 0, sent_ = 0, errors_ = 0, remote_ = 0, fd_ = 0, other_ids_ = 0;
  std::optional<drive::agilex::SystemState> chassis_;
  std::uint64_t stops_ = 0;
};

}  // namespace cairn::cli
