// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "fusion/peers/items/claim.hpp"
#include "fusion/team/graph/indexed_edge.hpp"

namespace cairn::team {

/// One edge that this robot publishes, and what was last published of it.
class PublishedEdge {
 public:
  explicit PublishedEdge(std::uint16_t index = 0) : index_(index) {}

  /// What comparing has come to: where the peer is, or nothing if that is not sure. Returns what is to
  /// be published now. An edge is published again when it moves by more than 2 cm or 0.003 rad, or is
  /// about other submaps. It is withdrawn, with probability 0, when it is not sure any more.
  [[nodiscard]] std::optional<IndexedEdge> update(const std::optional<peers::Edge>& edge);
  /// Whether it is published, and not withdrawn.
  [[nodiscard]] bool stands() const { return last_ && last_->probability > 0; }
  [[nodiscard]] std::uint16_t index() const { return index_; }

 private:
  std::uint16_t index_;
  std::optional<peers::Edge> last_;  // that was published
};

}  // namespace cairn::team
