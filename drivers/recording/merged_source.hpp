// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "hal/ports.hpp"

namespace cairn::recording {

/// Several recorded sources as one. Packets come in the order of (arrival, source, sequence). A source whose own
/// packets are not in that order keeps its order. Packet::source becomes the index in the list.
class MergedSource final : public Source {
 public:
  explicit MergedSource(std::vector<std::unique_ptr<Source>> sources);

  /// Never waits. An error of a source is handed on at once. All sources go on, that one too if it can.
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
