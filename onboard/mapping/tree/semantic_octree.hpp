// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/OccupancyOcTreeBase.h>
#include <octomap/octomap_types.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "onboard/mapping/tree/node_pool.hpp"
#include "onboard/mapping/tree/node_writer.hpp"
#include "onboard/mapping/tree/semantic_node.hpp"
#include "onboard/mapping/tree/sensor_model.hpp"

// OctoMap keeps children as an array of eight pointers. The functions that touch it are few, but not virtual; as
// members of a class template they can be specialised for our node, and everything else in OctoMap (iterators, search,
// castRay, updateNode, readers, writers) goes through them. They must be declared before anything instantiates them.
/// \cond OCTOMAP
namespace octomap {
using CairnTreeBase = OcTreeBaseImpl<cairn::mapping::SemanticNode, AbstractOccupancyOcTree>;

template <>
bool CairnTreeBase::nodeChildExists(const cairn::mapping::SemanticNode* node, unsigned i) const;
template <>
bool CairnTreeBase::nodeHasChildren(const cairn::mapping::SemanticNode* node) const;
template <>
cairn::mapping::SemanticNode* CairnTreeBase::getNodeChild(cairn::mapping::SemanticNode* node, unsigned i) const;
template <>
const cairn::mapping::SemanticNode* CairnTreeBase::getNodeChild(const cairn::mapping::SemanticNode* node,
                                                                unsigned i) const;
template <>
cairn::mapping::SemanticNode* CairnTreeBase::createNodeChild(cairn::mapping::SemanticNode* node, unsigned i);
template <>
void CairnTreeBase::deleteNodeChild(cairn::mapping::SemanticNode* node, unsigned i);
template <>
void CairnTreeBase::deleteNodeRecurs(cairn::mapping::SemanticNode* node);
}  // namespace octomap
/// \endcond

namespace cairn::mapping {

/// Owns the pool; a base class of its own, so that the pool outlives OctoMap's part of the tree.
class NodePoolHolder {
 protected:
  explicit NodePoolHolder(std::size_t largest_chunk) : pool_(largest_chunk) {}
  NodePool pool_;
};

/// The map: a real OctoMap tree with pooled nodes. All of OctoMap's interface works on it and gives what
/// octomap::OcTree gives; its files are OcTree files. Not honoured by Mapper: OctoMap's bounding box limit and change
/// detection. One thread edits at a time (Mapper splits its work by subtrees); readers must not run meanwhile.
class SemanticOcTree : private NodePoolHolder, public octomap::OccupancyOcTreeBase<SemanticNode> {
 public:
  static constexpr unsigned kDepth = 16;   ///< levels below the root; a node at this depth is one voxel
  static constexpr unsigned kWriters = 8;  ///< that many subtrees can be edited at the same time

  /// `resolution` is the edge of a voxel in metres; for `largest_chunk` see NodePool.
  explicit SemanticOcTree(double resolution, std::size_t largest_chunk = NodePool::kHugePage);
  /// Deep copy, in depth-first order and so defragmented; metadata and sensor model included.
  SemanticOcTree(const SemanticOcTree& other);
  SemanticOcTree& operator=(const SemanticOcTree&) = delete;
  /// The nodes go with the pool, unvisited.
  ~SemanticOcTree() override { drop_nodes(); }
  /// An empty map again, at no cost: its memory is kept for what comes, and no node is visited.
  void begin_anew();

  // OctoMap's virtual functions.
  [[nodiscard]] SemanticOcTree* create() const override { return new SemanticOcTree(resolution); }
  /// "OcTree", because files written by this tree are OcTree files and octovis opens them.
  [[nodiscard]] std::string getTreeType() const override { return "OcTree"; }
  [[nodiscard]] bool isNodeCollapsible(const SemanticNode* node) const override;
  void expandNode(SemanticNode* leaf) override;
  bool pruneNode(SemanticNode* node) override;
  /// Memory taken from the system for nodes, in bytes; what is in use of it is used_bytes().
  [[nodiscard]] std::size_t memoryUsage() const override { return sizeof(*this) + pool_.bytes(); }
  [[nodiscard]] std::size_t used_bytes() const;
  void swapContent(octomap::CairnTreeBase& other) = delete;  // nodes cannot leave their pool

  [[nodiscard]] SensorModel sensor_model() const;
  /// Log-odds to the bit, where OctoMap's own setters take probabilities.
  void set_sensor_model(const SensorModel& model);

  /// Gets and touches memory for about `bytes` of nodes now.
  void reserve_bytes(std::size_t bytes) { pool_.reserve(bytes / NodePool::kBlockBytes); }
  /// Prunes whatever can be pruned and sets every inner node to the maximum of its children: the one form in which
  /// equal maps are equal node by node. Eager updates keep it; OctoMap's readers, lazy updates and deleteNode do not.
  void canonicalise();
  [[nodiscard]] bool is_canonical() const;

  // For those who build the structure themselves (Mapper, the file readers).
  /// The root, made if there is none; `made` is set then.
  SemanticNode* root_or_new(bool& made);
  [[nodiscard]] NodeWriter& writer(unsigned i) { return writers_[i]; }
  /// Takes over what the writers have counted; to be called after editing through them.
  void settle_count();

 private:
  friend octomap::CairnTreeBase;
  void drop_nodes() {
    if (root != nullptr) root->set_block(nullptr);
    clear();
  }
  void copy_below(const SemanticNode* from, SemanticNode* to);

  std::vector<NodeWriter> writers_;
};

}  // namespace cairn::mapping

/// \cond OCTOMAP
namespace octomap {

template <>
inline bool CairnTreeBase::nodeChildExists(const cairn::mapping::SemanticNode* node, unsigned i) const {
  return node->block() != nullptr && node->block()[i].present();
}
template <>
inline bool CairnTreeBase::nodeHasChildren(const cairn::mapping::SemanticNode* node) const {
  return node->block() != nullptr;
}
template <>
inline cairn::mapping::SemanticNode* CairnTreeBase::getNodeChild(cairn::mapping::SemanticNode* node, unsigned i) const {
  return node->block() + i;
}
template <>
inline const cairn::mapping::SemanticNode* CairnTreeBase::getNodeChild(const cairn::mapping::SemanticNode* node,
                                                                       unsigned i) const {
  return node->block() + i;
}

}  // namespace octomap
/// \endcond
