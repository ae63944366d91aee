// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tree/node_pool.hpp"

#include <sys/mman.h>

#include <cstdlib>
#include <new>
#include <utility>

namespace cairn::mapping {
namespace {

constexpr std::size_t kSmallestChunk = std::size_t{64} << 10;  // bytes: eight batches
constexpr std::size_t kPage = 4096;                            // bytes, of x86-64 and aarch64

}  // namespace

NodePool::~NodePool() {
  for (const Chunk& chunk : chunks_) std::free(chunk.begin);  // nodes own nothing
}

SemanticNode* NodePool::take_batch() {
  const std::lock_guard lock(mutex_);
  blocks_out_ += kBatch;
  if (free_ == nullptr) return cut_batch();
  SemanticNode* batch = free_;
  free_ = batch[1].block();
  return batch;
}

void NodePool::give_batch(SemanticNode* batch) {
  const std::lock_guard lock(mutex_);
  blocks_out_ -= kBatch;
  batch[1].set_block(free_);
  free_ = batch;
}

void NodePool::reclaim() {
  const std::lock_guard lock(mutex_);
  free_ = nullptr;
  cutting_ = cut_ = blocks_out_ = 0;
}

void NodePool::reserve(std::size_t blocks) {
  const std::lock_guard lock(mutex_);
  while (bytes_ < blocks * kBlockBytes) {
    grow(largest_chunk_);
    auto* bytes = reinterpret_cast<volatile std::byte*>(chunks_.back().begin);
    for (std::size_t i = 0; i < largest_chunk_; i += kPage) bytes[i] = std::byte{0};
  }
}

std::size_t NodePool::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::size_t NodePool::blocks_out() const {
  const std::lock_guard lock(mutex_);
  return blocks_out_;
}

void NodePool::grow(std::size_t bytes) {
  const bool huge = bytes == kHugePage;
  void* memory = std::aligned_alloc(huge ? bytes : kPage, bytes);
  if (memory == nullptr) throw std::bad_alloc();
  if (huge) madvise(memory, bytes, MADV_HUGEPAGE);  // fewer TLB misses; only a hint
  chunks_.push_back({static_cast<SemanticNode*>(memory), bytes / kBlockBytes});
  bytes_ += bytes;
}

SemanticNode* NodePool::cut_batch() {
  if (cutting_ < chunks_.size() && cut_ == chunks_[cutting_].blocks) {
    ++cutting_;
    cut_ = 0;
  }
  if (cutting_ == chunks_.size()) grow(std::min(largest_chunk_, kSmallestChunk << std::min<std::size_t>(5, cutting_)));
  SemanticNode* first = chunks_[cutting_].begin + cut_ * SemanticNode::kChildren;
  cut_ += kBatch;
  for (std::size_t i = 0; i < kBatch; ++i) {
    SemanticNode* block = first + i * SemanticNode::kChildren;
    for (unsigned k = 0; k < SemanticNode::kChildren; ++k) new (block + k) SemanticNode;
    block->set_block(i + 1 < kBatch ? block + SemanticNode::kChildren : nullptr);
  }
  return first;
}

void BlockCache::refill() {
  list_ = spare_ != nullptr ? std::exchange(spare_, nullptr) : pool_->take_batch();
  count_ = NodePool::kBatch;
}

void BlockCache::spill() {
  if (spare_ != nullptr) pool_->give_batch(spare_);
  spare_ = std::exchange(list_, nullptr);
  count_ = 0;
}

}  // namespace cairn::mapping
