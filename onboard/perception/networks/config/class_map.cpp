// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/config/class_map.hpp"

#include <numeric>
#include <optional>
#include <utility>

#include "onboard/perception/networks/config/comma_list.hpp"

namespace cairn::networks {
namespace {

constexpr std::size_t kMaxChannels = 1000;
constexpr std::size_t kCocoClasses = 80;

/// The classes of COCO that Cityscapes has, too: index in the list of 80, and name of the trainId.
constexpr std::pair<std::size_t, std::string_view> kCoco[] = {
    {0, "person"}, {1, "bicycle"}, {2, "car"},           {3, "motorcycle"},   {5, "bus"},
    {6, "train"},  {7, "truck"},   {9, "traffic light"}, {11, "traffic sign"}};

std::vector<std::uint8_t> train_ids_in_order() {
  std::vector<std::uint8_t> ids(kSemanticClasses.size());
  std::iota(ids.begin(), ids.end(), std::uint8_t{0});
  return ids;
}

std::vector<std::uint8_t> coco() {
  std::vector<std::uint8_t> ids(kCocoClasses, kNoClass);
  for (const auto& [channel, name] : kCoco) ids[channel] = find_class(name).value_or(kNoClass);
  return ids;
}

std::optional<std::uint8_t> parse_entry(std::string_view text) {
  if (text == "none") return kNoClass;
  if (const auto id = find_class(text)) return id;
  const auto number = whole_number(text);
  if (!number || *number < 0 || *number >= static_cast<int>(kSemanticClasses.size())) return std::nullopt;
  return static_cast<std::uint8_t>(*number);
}

Error refusal(std::string detail) { return {Errc::kInvalidConfig, "not a list of classes", {}, {}, std::move(detail)}; }

}  // namespace

Result<ClassMap> ClassMap::parse(std::string_view text) {
  if (text == "cityscapes19") return ClassMap(train_ids_in_order());
  if (text == "identity") return ClassMap(train_ids_in_order(), true);
  if (text == "coco80") return ClassMap(coco());
  std::vector<std::uint8_t> ids;
  if (text == "cityscapes20") {
    ids = train_ids_in_order();
    ids.push_back(kNoClass);
    return ClassMap(std::move(ids));
  }
  for (const std::string_view part : comma_list(text)) {
    const auto id = parse_entry(part);
    if (!id)
      return refusal("'" + std::string(part.substr(0, 40)) +
                     "' is neither a built-in map (cityscapes19, cityscapes20, coco80, identity), nor a trainId "
                     "(0 to 18), nor the name of a class, nor none");
    if (ids.size() == kMaxChannels) return refusal("more than " + std::to_string(kMaxChannels) + " entries");
    ids.push_back(*id);
  }
  if (ids.empty()) return refusal("name a built-in map, or one class for each channel");
  return ClassMap(std::move(ids));
}

}  // namespace cairn::networks
