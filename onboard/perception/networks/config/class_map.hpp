// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "hal/semantic_class.hpp"

namespace cairn::networks {

/// What the channels of a network's output mean: the trainId of each, or kNoClass.
class ClassMap {
 public:
  /// A built-in map by its name, or a list with one entry for each channel: a trainId (0…18), the name of a class as in
  /// kSemanticClasses, or `none`. The built-in maps:
  /// - cityscapes19: channel i is trainId i
  /// - cityscapes20: the same, and channel 19 is no class
  /// - coco80: the 80 classes of COCO; people, vehicles, traffic lights and stop signs have a trainId
  /// - identity: channel i is trainId i, for any number of channels up to 19
  /// Error kInvalidConfig; its detail is the remedy.
  [[nodiscard]] static Result<ClassMap> parse(std::string_view text);

  /// Whether a network may have so many channels.
  [[nodiscard]] bool fits(std::size_t channels) const {
    return any_size_ ? channels >= 1 && channels <= train_ids_.size() : channels == train_ids_.size();
  }
  /// How many channels a network must have, for messages.
  [[nodiscard]] std::string size_text() const { return (any_size_ ? "1 to " : "") + std::to_string(train_ids_.size()); }
  /// The trainId of a channel; kNoClass for one beyond the map.
  [[nodiscard]] std::uint8_t operator[](std::size_t channel) const {
    return channel < train_ids_.size() ? train_ids_[channel] : kNoClass;
  }

 private:
  explicit ClassMap(std::vector<std::uint8_t> train_ids, bool any_size = false)
      : train_ids_(std::move(train_ids)), any_size_(any_size) {}

  std::vector<std::uint8_t> train_ids_;
  bool any_size_;
};

}  // namespace cairn::networks
