// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "drivers/clients/messages/record.hpp"
#include "hal/time.hpp"

namespace cairn::clients {

/// Something that happened, and how often so far. Texts are cut at kMaxText bytes.
struct EventMessage {
  static constexpr RecordKind kKind = RecordKind::kEvent;
  static constexpr std::size_t kMaxText = 240;

  Time stamp{};  ///< when it happened last
  std::uint64_t count = 0;
  std::string stage, what;
};

/// Appends the body. It is: stamp (8), count (8), stage (text), what (text).
void encode(const EventMessage& message, std::vector<std::byte>& out);
/// Error kMalformed.
[[nodiscard]] Result<EventMessage> decode_event(std::span<const std::byte> body);

}  // namespace cairn::clients
