// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/map.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <vector>

#include "hal/bytes.hpp"
#include "hal/semantic_class.hpp"
#include "onboard/mapping/files/octomap_file.hpp"
#include "onboard/mapping/tree/voxel_label.hpp"

namespace cairn::ros {
namespace {

using mapping::SemanticNode;
using mapping::VoxelLabel;
using Bytes = std::vector<std::byte>;

constexpr std::size_t kMostBytes = 64U << 20U;

/// The mean of colours, as octomap::ColorOcTreeNode takes it: white ones are none.
class MeanColour {
 public:
  void add(ClassColour colour) {
    if (colour == ClassColour{}) return;
    r_ += colour.r;
    g_ += colour.g;
    b_ += colour.b;
    ++count_;
  }
  [[nodiscard]] ClassColour value() const {
    const auto mean = [this](unsigned sum) { return static_cast<std::uint8_t>(sum / count_); };
    return count_ == 0 ? ClassColour{} : ClassColour{mean(r_), mean(g_), mean(b_)};
  }

 private:
  unsigned r_ = 0, g_ = 0, b_ = 0, count_ = 0;
};

/// Log-odds, colour, children; then these. It recurses, but never deeper than the tree: 16 levels.
ClassColour append_coloured(Bytes& out, const SemanticNode& node) {
  append_le(out, node.getLogOdds());
  const std::size_t colour_at = out.size();
  out.resize(out.size() + sizeof(ClassColour));
  const SemanticNode* block = node.block();
  unsigned children = 0;
  for (unsigned i = 0; i < SemanticNode::kChildren && block != nullptr; ++i)
    children |= (block[i].present() ? 1U : 0U) << i;
  append_le(out, static_cast<std::uint8_t>(children));
  MeanColour mean;
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
    if ((children >> i & 1U) != 0) mean.add(append_coloured(out, block[i]));
  const ClassColour colour = block == nullptr ? colour_of_label(node.label_id()) : mean.value();
  out[colour_at] = std::byte{colour.r};
  out[colour_at + 1] = std::byte{colour.g};
  out[colour_at + 2] = std::byte{colour.b};
  return colour;
}

/// What follows the text at the beginning of a file of OctoMap's.
std::span<const std::byte> without_text(std::span<const std::byte> file) {
  constexpr std::string_view kEnd = "\ndata\n";
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  return file.subspan(text.find(kEnd) + kEnd.size());
}

Bytes coloured(const mapping::SemanticOcTree& map) {
  Bytes out;
  if (map.getRoot() != nullptr) append_coloured(out, *map.getRoot());
  return out;
}

}  // namespace

ClassColour colour_of_label(std::uint32_t label_id) {
  const VoxelLabel label = VoxelLabel::from_id(label_id);
  if (!label.any()) return {};
  const SemanticClass& known = kSemanticClasses[label.class_id()];
  return {known.r, known.g, known.b};
}

Result<Octomap> octomap_of(const mapping::SemanticOcTree& map, MapForm form, const Header& header, Arena& arena) {
  const bool colour = form == MapForm::kColor, binary = form == MapForm::kBinary;
  const Bytes bytes = colour ? coloured(map) : binary ? mapping::encode_bt(map) : mapping::encode_ot(map);
  const std::span<const std::byte> data = colour ? std::span(bytes) : without_text(bytes);
  if (data.size() > kMostBytes) return Error{Errc::kLimit, "the map is too large for a message", {}, {}, {}};
  Octomap message{};
  message.header = header;
  message.binary = binary;
  message.id = arena.text(colour ? "ColorOcTree" : "OcTree");
  message.resolution = map.getResolution();
  const auto place = arena.sequence(message.data, data.size());
  if (!data.empty()) std::memcpy(place.data(), data.data(), data.size());
  return message;
}

}  // namespace cairn::ros
