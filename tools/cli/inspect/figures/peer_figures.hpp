// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "tools/cli/inspect/figures/sensor_figures.hpp"

namespace cairn::cli {

/// What a robot heard of its team: who spoke, how much of what kind, and what could not be read.
class PeerFigures final : public SensorFigures {
 public:
  static constexpr std::size_t kMaxPeers = 64;  ///< listed; further ones are only counted

  Result<const Scan*> take(const Packet& packet) override;
  [[nodiscard]] report::Json to_json() const override;

 private:
  struct PerPeer {
    std::string name;
    std::uint64_t hellos = 0, digests = 0, items = 0, bytes = 0;
  };
  std::uint64_t self_ = 0, epoch_ = 0, rejected_ = 0, others_ = 0;
  std::map<std::uint64_t, PerPeer> peers_;
};

}  // namespace cairn::cli
