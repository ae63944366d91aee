// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/map.hpp"

#include <cstring>
#include <string_view>
#include <vector>

#include "hal/semantic_class.hpp"
#include "onboard/mapping/files/octomap_file.hpp"
#include "onboard/mapping/tree/voxel_label.hpp"

namespace cairn::ros {
namespace {

using mapping::VoxelLabel;

constexpr std::size_t kMostBytes = 64U << 20U;

/// What follows the text at the beginning of a file of OctoMap's.
std::span<const std::byte> without_text(std::span<const std::byte> file) {
  constexpr std::string_view kEnd = "\ndata\n";
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  return file.subspan(text.find(kEnd) + kEnd.size());
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
  const auto type = colour ? mapping::OtTree::kColoured : mapping::OtTree::kPlain;
  const std::vector<std::byte> bytes = binary ? mapping::encode_bt(map) : mapping::encode_ot(map, type);
  const std::span<const std::byte> data = without_text(bytes);
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
