// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "hal/histogram.hpp"
#include "hal/packet.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {

/// Counts, sizes, rates and gaps of one source's packets. Memory is bounded whatever comes.
class PacketFigures {
 public:
  void add(const Packet& packet);
  [[nodiscard]] report::Json to_json() const;

 private:
  struct Channel {
    std::uint64_t packets = 0;
    std::map<std::size_t, std::uint64_t> sizes;
    std::uint64_t other_sizes = 0;
  };
  [[nodiscard]] std::uint64_t gaps(Duration longer_than) const;

  std::map<std::uint16_t, Channel> channels_;
  Histogram intervals_;
  std::uint64_t packets_ = 0, bytes_ = 0, truncated_ = 0, backwards_ = 0, missing_ = 0;
  std::uint64_t next_sequence_ = 0;
  Time first_{}, last_{};
};

}  // namespace cairn::cli
