// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// A copy of a map that goes on growing, made a slice at a time between two scans. Each cube of 32
/// voxels is copied whole; it shows the map as it was when its turn came, so that one cube may know
/// some scans more than another.
class TreeCopy {
 public:
  explicit TreeCopy(const SemanticOcTree& from);

  /// Goes on for about so many nodes, and at least for one cube. `from` is the tree of the
  /// constructor, and nobody changes it meanwhile. True: the copy is complete.
  bool step(const SemanticOcTree& from, std::size_t nodes);
  /// The complete copy; it is canonical once canonicalise() was called, which this leaves to a
  /// thread that has time.
  [[nodiscard]] std::unique_ptr<SemanticOcTree> take() { return std::move(copy_); }

 private:
  static constexpr unsigned kSliceDepth = 11;  // a slice is a cube of 32 voxels: 3.2 m at 0.1 m

  /// A node, and the slices below it as a range of Morton codes.
  struct Place {
    unsigned depth;
    std::uint64_t first;
    [[nodiscard]] std::uint64_t end() const { return first + (std::uint64_t{1} << (3 * (kSliceDepth - depth))); }
    [[nodiscard]] Place child(unsigned i) const {
      return {depth + 1, first + (std::uint64_t{i} << (3 * (kSliceDepth - depth - 1)))};
    }
  };
  void copy_rest(const SemanticNode* from, SemanticNode* to, const Place& place);
  void copy_whole(const SemanticNode* from, SemanticNode* to);

  std::unique_ptr<SemanticOcTree> copy_;
  std::uint64_t next_ = 0;  // slices before it are copied
  std::size_t left_ = 0;    // nodes that this step may still copy
};

}  // namespace cairn::mapping
