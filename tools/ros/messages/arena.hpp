// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory_resource>
#include <span>
#include <string_view>
#include <type_traits>

namespace cairn::ros {

/// The memory behind the texts and sequences of messages. Everything in it goes at once.
class Arena {
 public:
  /// A copy that ends with a zero; a zero inside ends it, as in C.
  [[nodiscard]] char* text(std::string_view text) {
    auto* copy = static_cast<char*>(memory_.allocate(text.size() + 1, 1));
    if (!text.empty()) std::memcpy(copy, text.data(), text.size());
    copy[text.size()] = '\0';
    return copy;
  }
  /// Makes a generated sequence `size` zeroed elements long, and returns these.
  template <class Sequence>
  auto sequence(Sequence& sequence, std::size_t size) {
    using Element = std::remove_pointer_t<decltype(sequence._buffer)>;
    static_assert(std::is_trivial_v<Element>);
    const auto count = static_cast<std::uint32_t>(size);
    auto* elements = static_cast<Element*>(memory_.allocate(count * sizeof(Element) + 1, alignof(Element)));
    std::memset(elements, 0, count * sizeof(Element));
    sequence._buffer = elements;
    sequence._length = sequence._maximum = count;
    sequence._release = false;
    return std::span<Element>(elements, count);
  }
  /// Ends all messages made with it.
  void clear() { memory_.release(); }

 private:
  std::pmr::monotonic_buffer_resource memory_{4096};
};

}  // namespace cairn::ros
