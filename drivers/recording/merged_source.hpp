// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "hal/ports.hpp"

namespace cairn::recording {

/// Several recorded sources as one: packets in the order of (arrival, source, sequence). A source whose own packets are
/// not in that order keeps its order. The packets' `source` becomes the index in the list given.
class MergedSource final : public Source {
 public:
  explicit MergedSource(std::vector<std::unique_ptr<Source>> sources);

  /// A source's error is handed on at once; the other sources go on, and so does that one if it can.
  Result<Poll> next(Packet& packet, Duration timeout) override;

 private:
  struct Head {
    std::unique_ptr<Source> source;
    Packet packet;
    bool filled = false, ended = false;
  };
  [[nodiscard]] static bool earlier(const Head& a, const Head& b);

  std::vector<Head> heads_;
};

}  // namespace cairn::recording
