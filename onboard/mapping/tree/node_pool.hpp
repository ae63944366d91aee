// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

#include "onboard/mapping/tree/semantic_node.hpp"

namespace cairn::mapping {

/// The memory of one tree: blocks of eight nodes, cut from large chunks that never move, so node
/// pointers stay valid. Memory goes back to the system only with the pool. Threads do not come here
/// for every block, but take and give batches through a BlockCache of their own.
class NodePool {
 public:
  static constexpr std::size_t kBlockBytes = SemanticNode::kChildren * sizeof(SemanticNode);
  static constexpr std::size_t kBatch = 64;                       ///< blocks that change hands at once: 8 KiB
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;  ///< bytes, of x86-64 and aarch64

  /// The pool grows in chunks of up to `largest_chunk` bytes, a power of two from 64 KiB to
  /// kHugePage. Where memory is locked, the kernel fills all of a chunk at once: small ones bound
  /// what a step can cost, huge pages make access fast.
  explicit NodePool(std::size_t largest_chunk = kHugePage) : largest_chunk_(largest_chunk) {}
  NodePool(const NodePool&) = delete;
  NodePool& operator=(const NodePool&) = delete;
  ~NodePool();

  /// kBatch blocks, linked through the block pointer of their first node; their contents are
  /// unspecified.
  [[nodiscard]] SemanticNode* take_batch();
  /// The reverse: a list of exactly kBatch blocks.
  void give_batch(SemanticNode* batch);
  /// Takes all blocks back, whoever has them, and keeps the memory. Their BlockCaches must be made
  /// anew.
  void reclaim();
  /// Gets memory for `blocks` in all from the system and touches it, so that no scan pays for page
  /// faults.
  void reserve(std::size_t blocks);

  /// Memory taken from the system.
  [[nodiscard]] std::size_t bytes() const;
  /// Blocks in the hands of BlockCaches.
  [[nodiscard]] std::size_t blocks_out() const;

 private:
  struct Chunk {
    SemanticNode* begin;
    std::size_t blocks;
  };
  void grow(std::size_t bytes);
  [[nodiscard]] SemanticNode* cut_batch();

  std::size_t largest_chunk_;
  mutable std::mutex mutex_;
  std::vector<Chunk> chunks_;
  std::size_t cutting_ = 0;       // the chunk new batches are cut from
  std::size_t cut_ = 0;           // its blocks that are cut already
  SemanticNode* free_ = nullptr;  // given batches, linked through the second node of their first block
  std::size_t bytes_ = 0;
  std::size_t blocks_out_ = 0;
};

/// One thread's stock of blocks: between none and two batches.
class BlockCache {
 public:
  explicit BlockCache(NodePool& pool) : pool_(&pool) {}

  /// A block whose contents are unspecified.
  [[nodiscard]] SemanticNode* take() {
    if (count_ == 0) refill();
    SemanticNode* block = list_;
    list_ = block->block();
    --count_;
    return block;
  }
  void give(SemanticNode* block) {
    if (count_ == NodePool::kBatch) spill();
    block->set_block(list_);
    list_ = block;
    ++count_;
  }
  /// Blocks in stock.
  [[nodiscard]] std::size_t size() const { return count_ + (spare_ != nullptr ? NodePool::kBatch : 0); }

 private:
  void refill();
  void spill();

  NodePool* pool_;
  SemanticNode* list_ = nullptr;
  std::size_t count_ = 0;          // blocks in list_
  SemanticNode* spare_ = nullptr;  // one whole batch, so that take and give in turns do not run to the pool
};

}  // namespace cairn::mapping
