// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/files/cairn_file.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include "hal/bytes.hpp"
#include "onboard/mapping/files/cairn_format.hpp"
#include "onboard/mapping/tree/label_evidence.hpp"

namespace cairn::mapping {
namespace {

using cairn_format::Chunk;
using cairn_format::Header;
using cairn_format::LeafLabel;
using Tree = Result<std::unique_ptr<SemanticOcTree>>;

constexpr int kZstdLevel = 3;  // zstd's default

/// The least form that keeps all labels of the leaves below a node.
// As deep as the tree: 16 levels.
// NOLINTNEXTLINE(misc-no-recursion)
LeafLabel form_of_labels(const SemanticNode& node) {
  if (node.block() == nullptr) {
    if (!node.present() || !VoxelLabel::from_id(node.label_id()).any()) return LeafLabel::kNone;
    return (node.label_id() & LabelEvidence::kMark) != 0 ? LeafLabel::kEvidence : LeafLabel::kCode;
  }
  auto most = LeafLabel::kNone;
  for (unsigned i = 0; i < SemanticNode::kChildren && most != LeafLabel::kEvidence; ++i)
    most = std::max(most, form_of_labels(node.block()[i]));
  return most;
}
LeafLabel form_of_labels(const SemanticOcTree& tree) {
  return tree.getRoot() != nullptr ? form_of_labels(*tree.getRoot()) : LeafLabel::kNone;
}

/// Turns a canonical tree into compressed chunks.
class ChunkWriter {
 public:
  explicit ChunkWriter(LeafLabel label) : label_(label) {}

  void node(const SemanticNode& node) {
    if (structure_.size() + values_.size() >= cairn_format::kChunkBytes) flush();
    const SemanticNode* block = node.block();
    if (block == nullptr) {
      append_le(values_, node.getLogOdds());
      if (label_ == LeafLabel::kCode) append_le(values_, VoxelLabel::from_id(node.label_id()).code);
      if (label_ == LeafLabel::kEvidence) append_le(values_, is_label_id(node.label_id()) ? node.label_id() : 0U);
      return;
    }
    unsigned children = 0, inner = 0;
    for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
      children |= (block[i].present() ? 1U : 0U) << i;
      inner |= (block[i].block() != nullptr ? 1U : 0U) << i;
    }
    append_le(structure_, static_cast<std::uint8_t>(children));
    append_le(structure_, static_cast<std::uint8_t>(inner));
    for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
      if (block[i].present()) this->node(block[i]);  // as deep as the tree: 16 levels
  }

  void flush() {
    if (structure_.empty() && values_.empty()) return;
    std::vector<std::byte> raw;
    append_le(raw, static_cast<std::uint32_t>(structure_.size()));
    raw.insert(raw.end(), structure_.begin(), structure_.end());
    raw.insert(raw.end(), values_.begin(), values_.end());
    std::vector<std::byte> frame(ZSTD_compressBound(raw.size()));
    const std::size_t size = ZSTD_compress(frame.data(), frame.size(), raw.data(), raw.size(), kZstdLevel);
    assert(!ZSTD_isError(size));  // can only fail for lack of room, and the room is the bound
    frame.resize(size);
    chunks.push_back(
        {static_cast<std::uint32_t>(raw.size()), static_cast<std::uint32_t>(size), cairn_format::hash(frame)});
    stored.insert(stored.end(), frame.begin(), frame.end());
    structure_.clear();
    values_.clear();
  }

  std::vector<Chunk> chunks;
  std::vector<std::byte> stored;

 private:
  LeafLabel label_;
  std::vector<std::byte> structure_, values_;
};

/// Hands out the nodes' bytes, decompressing one chunk at a time.
class ChunkReader {
 public:
  ChunkReader(std::span<const std::byte> bytes, const Header& header)
      : bytes_(bytes), header_(header), offset_(header.bytes) {}

  template <class T>
  Result<T> structure() {
    return read<T>(structure_);
  }
  Result<float> value() { return read<float>(values_); }
  /// Of the leaf whose value was read.
  Result<std::uint32_t> label_id() {
    std::optional<std::uint32_t> id = 0U;
    if (header_.label == LeafLabel::kCode) id = values_.read<std::uint8_t>();
    if (header_.label == LeafLabel::kEvidence) id = values_.read<std::uint32_t>();
    if (id && is_label_id(*id)) return *id;
    return Error{Errc::kMalformed, "a leaf has no label, or one that is none", {}, chunk_offset_, {}};
  }
  /// Nothing is left over.
  [[nodiscard]] bool exhausted() const { return empty() && next_ == header_.chunks.size(); }
  /// Of the chunk in use, in the file.
  [[nodiscard]] std::uint64_t offset() const { return chunk_offset_; }

 private:
  [[nodiscard]] bool empty() const { return structure_.remaining() == 0 && values_.remaining() == 0; }

  template <class T>
  Result<T> read(ByteReader& part) {
    if (empty())
      if (Result<void> opened = open_next(); !opened) return opened.error();
    if (const auto value = part.read<T>()) return *value;
    return Error{Errc::kMalformed, "a chunk ends inside the tree", {}, chunk_offset_, {}};
  }

  Result<void> open_next() {
    chunk_offset_ = offset_;
    if (next_ == header_.chunks.size()) return Error{Errc::kMalformed, "nodes are missing", {}, chunk_offset_, {}};
    const Chunk& chunk = header_.chunks[next_++];
    raw_.resize(chunk.raw_bytes);  // bounded by mapping::cairn_format::parse()
    const auto frame = bytes_.subspan(offset_, chunk.stored_bytes);
    offset_ += chunk.stored_bytes;
    if (ZSTD_decompress(raw_.data(), raw_.size(), frame.data(), frame.size()) != raw_.size())
      return Error{Errc::kMalformed, "a chunk does not decompress to what it claims", {}, chunk_offset_, {}};
    ByteReader raw(raw_);
    const auto length = raw.read<std::uint32_t>();
    const auto structure = length ? raw.read_bytes(*length) : std::nullopt;
    if (!structure || raw.remaining() + structure->size() == 0)
      return Error{Errc::kMalformed, "a chunk is empty or too short", {}, chunk_offset_, {}};
    structure_ = ByteReader(*structure);
    values_ = ByteReader(*raw.read_bytes(raw.remaining()));
    return {};
  }

  std::span<const std::byte> bytes_;
  const Header& header_;
  std::size_t next_ = 0, offset_;
  std::uint64_t chunk_offset_ = 0;
  std::vector<std::byte> raw_;
  ByteReader structure_{{}}, values_{{}};
};

/// Gives the builder its next node, as the masks of its parent say.
class NodeReader {
 public:
  NodeReader(ChunkReader& chunks, TreeBuilder& builder, bool root_is_leaf)
      : chunks_(chunks), builder_(builder), root_is_leaf_(root_is_leaf) {}

  Result<void> next() {
    const unsigned depth = builder_.depth();
    const bool leaf = depth == 0 ? root_is_leaf_ : ((inner_[depth - 1] >> builder_.child_index()) & 1U) == 0;
    if (leaf) {
      const auto value = chunks_.value();
      if (!value) return value.error();
      const auto label_id = chunks_.label_id();
      return label_id ? builder_.leaf(*value, *label_id) : label_id.error();
    }
    const auto masks = chunks_.structure<std::uint16_t>();
    if (!masks) return masks.error();
    const auto children = static_cast<std::uint8_t>(*masks & 0xFFU), inner = static_cast<std::uint8_t>(*masks >> 8U);
    if ((inner & ~children) != 0) return Error{Errc::kMalformed, "an inner node is not a child", {}, {}, {}};
    if (depth < inner_.size()) inner_[depth] = inner;  // deeper than that, the builder refuses
    return builder_.inner(children);
  }

 private:
  ChunkReader& chunks_;
  TreeBuilder& builder_;
  bool root_is_leaf_;
  std::array<std::uint8_t, SemanticOcTree::kDepth> inner_{};  // of the open inner node at each depth
};

Result<void> read_nodes(ChunkReader& chunks, const Header& header, const MapLimits& limits, SemanticOcTree& tree) {
  TreeBuilder builder(tree, limits);
  NodeReader reader(chunks, builder, header.nodes == 1);
  while (header.nodes > 0 && !builder.done())
    if (Result<void> given = reader.next(); !given) return given;
  if (builder.nodes() != header.nodes || !chunks.exhausted())
    return Error{Errc::kMalformed, "the header announces another number of nodes", {}, {}, {}};
  if (header.label != form_of_labels(tree))
    return Error{Errc::kMalformed, "the header announces other labels than there are", {}, {}, {}};
  if (tree.size() != header.nodes) return Error{Errc::kMalformed, "the tree is not pruned", {}, {}, {}};
  return {};
}

}  // namespace

std::vector<std::byte> encode_cairn(const SemanticOcTree& tree, std::string_view metadata) {
  assert(metadata.size() <= cairn_format::kMaxMetadataBytes);
  if (!tree.is_canonical()) {
    SemanticOcTree canonical(tree);
    canonical.canonicalise();
    return encode_cairn(canonical, metadata);
  }
  const LeafLabel label = form_of_labels(tree);
  ChunkWriter writer(label);
  if (tree.getRoot() != nullptr) writer.node(*tree.getRoot());
  writer.flush();
  const Header header{
      tree.getResolution(), tree.sensor_model(), tree.size(), metadata, std::move(writer.chunks), 0, label};
  return cairn_format::assemble(header, writer.stored);
}

Tree decode_cairn(std::span<const std::byte> bytes, const MapLimits& limits) {
  const auto header = cairn_format::parse(bytes);
  if (!header) return header.error();
  auto tree = std::make_unique<SemanticOcTree>(header->resolution);
  tree->set_sensor_model(header->sensor_model);
  ChunkReader chunks(bytes, *header);
  if (Result<void> read = read_nodes(chunks, *header, limits, *tree); !read) {
    Error error = read.error();
    if (!error.offset) error.offset = chunks.offset();
    return error;
  }
  return tree;
}

Result<std::string> decode_cairn_metadata(std::span<const std::byte> bytes) {
  const auto header = cairn_format::parse(bytes);
  if (!header) return header.error();
  return std::string(header->metadata);
}

bool is_cairn(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.starts_with(cairn_format::kMagic);
}

}  // namespace cairn::mapping
