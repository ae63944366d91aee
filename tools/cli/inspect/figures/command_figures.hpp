// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "tools/cli/inspect/figures/sensor_figures.hpp"

namespace cairn::cli {

/// What came by the command socket: commands by verb, and the names of the clients that sent them.
class CommandFigures final : public SensorFigures {
 public:
  static constexpr std::size_t kMaxNames = 16;  ///< listed

  Result<const Scan*> take(const Packet& packet) override;
  [[nodiscard]] report::Json to_json() const override;

 private:
  std::uint64_t connections_ = 0;
  std::map<std::string, std::uint64_t> verbs_;
  std::set<std::string> names_;
  double fastest_m_s_ = 0, fastest_rad_s_ = 0;
};

}  // namespace cairn::cli
