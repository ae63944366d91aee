// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/files/octomap_file.hpp"

#include <array>
#include <charconv>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "hal/bytes.hpp"
#include "onboard/mapping/files/class_colour.hpp"
#include "onboard/mapping/tree/voxel_label.hpp"

namespace cairn::mapping {
namespace {

using Tree = Result<std::unique_ptr<SemanticOcTree>>;

constexpr std::string_view kFirstLineOt = "# Octomap OcTree file";
constexpr std::string_view kFirstLineBt = "# Octomap OcTree binary file";
constexpr std::string_view kColoured = "ColorOcTree";  // a tree's type
constexpr std::size_t kMaxHeaderBytes = 4096;
constexpr double kMinResolution = 1e-4, kMaxResolution = 100.0;

struct Header {
  std::string id;
  std::uint64_t size = 0;
  double resolution = 0.0;
  std::size_t data_offset = 0;
};

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Error fault(Errc code, std::string_view cause, std::uint64_t offset, std::string detail = {}) {
  return {code, cause, {}, offset, std::move(detail)};
}

/// The value of a header line such as "res 0.1"; the whole value must be a number.
template <class T>
bool parse_number(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

Result<void> parse_line(std::string_view line, std::size_t offset, Header& header) {
  const std::size_t space = line.find(' ');
  const std::string_view key = line.substr(0, space);
  const std::string_view value = space == line.npos ? std::string_view{} : line.substr(space + 1);
  if (key == "id") {
    header.id = value;
  } else if (key == "size") {
    if (!parse_number(value, header.size)) return fault(Errc::kMalformed, "`size` is not a number", offset);
  } else if (key == "res") {
    if (!parse_number(value, header.resolution)) return fault(Errc::kMalformed, "`res` is not a number", offset);
  } else if (!line.empty() && line.front() != '#') {
    return fault(Errc::kMalformed, "unknown header line", offset, std::string(key.substr(0, 32)));
  }
  return {};
}

Result<void> check(const Header& header) {
  if (!(header.resolution >= kMinResolution && header.resolution <= kMaxResolution))
    return fault(Errc::kMalformed, "the resolution is missing or senseless", 0,
                 std::to_string(header.resolution) + " m");
  if (header.id != "OcTree" && header.id != kColoured)
    return fault(Errc::kUnsupported, "the tree type is not supported", 0, header.id.substr(0, 64));
  return {};
}

Result<Header> parse_header(std::span<const std::byte> bytes) {
  const std::string_view text = as_text(bytes.first(std::min(bytes.size(), kMaxHeaderBytes)));
  Header header;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (end == text.npos) break;
    std::string_view line = text.substr(begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    header.data_offset = end + 1;
    if (line == "data") {
      if (const auto checked = check(header); !checked) return checked.error();
      return header;
    }
    if (const auto parsed = parse_line(line, begin, header); !parsed) return parsed.error();
    begin = end + 1;
  }
  return fault(bytes.size() < kMaxHeaderBytes ? Errc::kTruncated : Errc::kMalformed, "the header has no line `data`",
               text.size());
}

/// Runs `next(tree, builder, reader)` for every node after the header, and checks what must hold for both formats.
template <class Next>
Tree decode(std::span<const std::byte> bytes, const MapLimits& limits, Next next) {
  const auto header = parse_header(bytes);
  if (!header) return header.error();
  auto tree = std::make_unique<SemanticOcTree>(header->resolution);
  TreeBuilder builder(*tree, limits);
  ByteReader reader(bytes.subspan(header->data_offset));
  while (header->size > 0 && !builder.done()) {
    const std::uint64_t offset = header->data_offset + reader.offset();
    if (builder.nodes() >= header->size)
      return fault(Errc::kMalformed, "more nodes than the header announces", offset, std::to_string(header->size));
    if (Result<void> given = next(*header, *tree, builder, reader); !given) {
      Error error = given.error();
      error.offset = offset;
      return error;
    }
  }
  if (builder.nodes() != header->size)
    return fault(Errc::kMalformed, "fewer nodes than the header announces", header->data_offset + reader.offset(),
                 std::to_string(builder.nodes()) + " of " + std::to_string(header->size));
  if (reader.remaining() != 0)
    return fault(Errc::kMalformed, "bytes follow the last node", header->data_offset + reader.offset());
  return tree;
}

const Error kTruncated{Errc::kTruncated, "the file ends inside the tree", {}, {}, {}};

/// The label of a leaf with these bytes of colour: free space has none.
VoxelLabel label_of(float log_odds, std::span<const std::byte> colour) {
  const auto part = [&](std::size_t i) { return std::to_integer<std::uint8_t>(colour[i]); };
  const auto class_id = log_odds < 0 ? std::nullopt : class_of({part(0), part(1), part(2)});
  return class_id ? VoxelLabel::of(*class_id, 0) : VoxelLabel{};
}

Result<void> next_ot(const Header& header, SemanticOcTree&, TreeBuilder& builder, ByteReader& reader) {
  const auto log_odds = reader.read<float>();
  const auto colour = reader.read_bytes(header.id == kColoured ? 3 : 0);
  const auto children = reader.read<std::uint8_t>();
  if (!log_odds || !colour || !children) return kTruncated;
  if (*children != 0) return builder.inner(*children);
  return builder.leaf(*log_odds, colour->empty() ? 0U : label_of(*log_odds, *colour).code);
}

/// One bit pair per child: 0 unknown, 1 free, 2 occupied, 3 inner.
unsigned kind_of(std::uint16_t pairs, unsigned child) { return (pairs >> (2 * child)) & 3U; }

class BtNodes {
 public:
  Result<void> operator()(const Header&, SemanticOcTree& tree, TreeBuilder& builder, ByteReader& reader) {
    const unsigned depth = builder.depth();
    const unsigned kind = depth == 0 ? 3 : kind_of(pairs_[depth - 1], builder.child_index());
    if (kind == 1) return builder.leaf(tree.sensor_model().min);
    if (kind == 2) return builder.leaf(tree.sensor_model().max);
    const auto pairs = reader.read<std::uint16_t>();
    if (!pairs) return kTruncated;
    unsigned children = 0;
    for (unsigned i = 0; i < SemanticNode::kChildren; ++i) children |= (kind_of(*pairs, i) != 0 ? 1U : 0U) << i;
    if (depth < pairs_.size()) pairs_[depth] = *pairs;  // deeper than that, the builder refuses
    return builder.inner(static_cast<std::uint8_t>(children));
  }

 private:
  std::array<std::uint16_t, SemanticOcTree::kDepth> pairs_{};  // of the open inner node at each depth
};

std::vector<std::byte> header_bytes(std::string_view first_line, std::string_view type, const SemanticOcTree& tree) {
  std::ostringstream out;  // as OctoMap does: `res` gets six digits
  out << first_line << "\n# (feel free to add / change comments, but leave the first line as it is!)\n#\nid " << type
      << "\nsize " << tree.size() << "\nres " << tree.getResolution() << "\ndata\n";
  const std::string text = std::move(out).str();
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// One bit for each child that is there.
unsigned children_of(const SemanticNode& node) {
  unsigned children = 0;
  for (unsigned i = 0; i < SemanticNode::kChildren && node.block() != nullptr; ++i)
    children |= (node.block()[i].present() ? 1U : 0U) << i;
  return children;
}

// These recurse, but never deeper than the tree: 16 levels.
void append_ot(std::vector<std::byte>& out, const SemanticNode& node) {
  const unsigned children = children_of(node);
  append_le(out, node.getLogOdds());
  append_le(out, static_cast<std::uint8_t>(children));
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
    if ((children >> i & 1) != 0) append_ot(out, node.block()[i]);
}

VoxelLabel label_of(const SemanticNode& leaf) {
  return leaf.getLogOdds() < 0 ? VoxelLabel{} : VoxelLabel::from_id(leaf.label_id());
}

bool any_label(const SemanticNode& node) {
  const unsigned children = children_of(node);
  if (children == 0) return label_of(node).any();
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
    if ((children >> i & 1) != 0 && any_label(node.block()[i])) return true;
  return false;
}

/// The colour of an inner node is the mean of its children's that have one, as OctoMap computes it.
class MeanColour {
 public:
  void add(const Colour& colour) {
    if (colour == kNoColour) return;
    for (std::size_t i = 0; i < colour.size(); ++i) sums_[i] += colour[i];
    ++count_;
  }
  [[nodiscard]] Colour mean() const {
    if (count_ == 0) return kNoColour;
    const auto of = [&](std::size_t i) { return static_cast<std::uint8_t>(sums_[i] / count_); };
    return {of(0), of(1), of(2)};
  }

 private:
  std::array<unsigned, 3> sums_{};
  unsigned count_ = 0;
};

/// Appends the node and all below; returns its colour.
Colour append_coloured(std::vector<std::byte>& out, const SemanticNode& node) {
  const unsigned children = children_of(node);
  append_le(out, node.getLogOdds());
  const std::size_t place = out.size();
  out.resize(place + 3);
  append_le(out, static_cast<std::uint8_t>(children));
  MeanColour mean;
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
    if ((children >> i & 1) != 0) mean.add(append_coloured(out, node.block()[i]));
  const VoxelLabel label = label_of(node);
  const Colour leaf = label.any() ? colour_of(static_cast<std::uint8_t>(label.class_id())) : kNoColour;
  const Colour colour = children == 0 ? leaf : mean.mean();
  for (std::size_t i = 0; i < colour.size(); ++i) out[place + i] = std::byte{colour[i]};
  return colour;
}

void append_bt(std::vector<std::byte>& out, const SemanticOcTree& tree, const SemanticNode& node) {
  const SemanticNode* block = node.block();
  unsigned pairs = 0;
  for (unsigned i = 0; i < SemanticNode::kChildren && block != nullptr; ++i) {
    const unsigned leaf = tree.isNodeOccupied(block[i]) ? 2 : 1;
    pairs |= (!block[i].present() ? 0 : block[i].block() != nullptr ? 3 : leaf) << (2 * i);
  }
  append_le(out, static_cast<std::uint16_t>(pairs));
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
    if (kind_of(static_cast<std::uint16_t>(pairs), i) == 3) append_bt(out, tree, block[i]);
}

bool starts_with_line(std::span<const std::byte> bytes, std::string_view line) {
  return as_text(bytes).starts_with(line);
}

}  // namespace

Tree decode_ot(std::span<const std::byte> bytes, const MapLimits& limits) {
  if (!is_ot(bytes)) return fault(Errc::kMalformed, "not an OctoMap .ot file", 0);
  return decode(bytes, limits, next_ot);
}

Tree decode_bt(std::span<const std::byte> bytes, const MapLimits& limits) {
  if (!is_bt(bytes)) return fault(Errc::kMalformed, "not an OctoMap .bt file", 0);
  return decode(bytes, limits, BtNodes{});
}

std::vector<std::byte> encode_ot(const SemanticOcTree& tree, OtTree type) {
  const SemanticNode* root = tree.getRoot();
  const bool coloured = type == OtTree::kByLabels ? root != nullptr && any_label(*root) : type == OtTree::kColoured;
  std::vector<std::byte> out = header_bytes(kFirstLineOt, coloured ? kColoured : tree.getTreeType(), tree);
  if (coloured && root != nullptr) {
    append_coloured(out, *root);
  } else if (root != nullptr) {
    append_ot(out, *root);
  }
  return out;
}

std::vector<std::byte> encode_bt(const SemanticOcTree& tree) {
  SemanticOcTree likely(tree);
  likely.toMaxLikelihood();
  likely.prune();
  // The format has no word for a root without children: OctoMap itself writes an unknown map then.
  if (likely.getRoot() != nullptr && likely.getRoot()->block() == nullptr) likely.expandNode(likely.getRoot());
  std::vector<std::byte> out = header_bytes(kFirstLineBt, likely.getTreeType(), likely);
  if (likely.getRoot() != nullptr) append_bt(out, likely, *likely.getRoot());
  return out;
}

bool is_ot(std::span<const std::byte> bytes) { return starts_with_line(bytes, kFirstLineOt); }
bool is_bt(std::span<const std::byte> bytes) { return starts_with_line(bytes, kFirstLineBt); }

}  // namespace cairn::mapping
