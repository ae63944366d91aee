// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn {

/// The map of an epoch that has ended.
struct EarlierMap {
  std::uint32_t epoch = 0;
  std::shared_ptr<const mapping::SemanticOcTree> tree;
  /// The later epoch whose map got what this one knew, and how this one lies in it; none: that is not known.
  struct Joined {
    std::uint32_t epoch = 0;
    UncertainPose T_later_earlier;
  };
  std::optional<Joined> joined{};
  std::optional<UncertainPose> T_next_earlier{};  ///< a guess of how it lies in the map of the next epoch
};

/// The maps that a robot made before it lost its way, and how they lie in later ones. Bounded: the largest are kept.
class EarlierMaps {
 public:
  static constexpr std::size_t kMost = 3;

  /// An epoch has ended with this map; an empty one is not kept. Beyond kMost one is dropped: the smallest of those
  /// that were joined to a later map, or else the smallest. `T_next_earlier`: see EarlierMap.
  void keep(std::uint32_t epoch, std::unique_ptr<mapping::SemanticOcTree> tree,
            const std::optional<UncertainPose>& T_next_earlier = {});
  /// The map of `later` got what that of `earlier` knew.
  void join(std::uint32_t earlier, std::uint32_t later, const UncertainPose& T_later_earlier);

  /// The oldest first.
  [[nodiscard]] const std::vector<EarlierMap>& all() const { return maps_; }
  /// How many were dropped before they were joined.
  [[nodiscard]] std::size_t dropped() const { return dropped_; }
  /// How the map of one epoch lies in that of a later one, by what was joined, through those between them. None: that
  /// is not known.
  [[nodiscard]] std::optional<UncertainPose> between(std::uint32_t later, std::uint32_t earlier) const;

 private:
  struct Link {
    std::uint32_t earlier = 0;
    EarlierMap::Joined joined;
  };
  void drop_one();

  std::vector<EarlierMap> maps_;
  std::vector<Link> links_;  // of dropped maps, too
  std::size_t dropped_ = 0;
};

}  // namespace cairn
