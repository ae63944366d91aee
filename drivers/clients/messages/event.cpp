// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/event.hpp"

#include "drivers/clients/messages/field_reader.hpp"

namespace cairn::clients {

void encode(const EventMessage& message, std::vector<std::byte>& out) {
  append_time(out, message.stamp);
  append_le(out, message.count);
  append_text(out, message.stage, EventMessage::kMaxText);
  append_text(out, message.what, EventMessage::kMaxText);
}

Result<EventMessage> decode_event(std::span<const std::byte> body) {
  FieldReader in(body);
  EventMessage message;
  message.stamp = in.time();
  message.count = in.number<std::uint64_t>();
  message.stage = in.text(EventMessage::kMaxText);
  message.what = in.text(EventMessage::kMaxText);
  if (!in.complete()) return in.error("not an event");
  return message;
}

}  // namespace cairn::clients
