// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/subscribe.hpp"

#include "drivers/clients/messages/field_reader.hpp"

namespace cairn::clients {
namespace {

void append_resume(std::vector<std::byte>& out, const SubscribeMessage::Resume& resume) {
  append_le(out, resume.session);
  append_le(out, resume.version);
  append_le(out, resume.epoch);
  append_le(out, std::uint32_t{0});
}

SubscribeMessage::Resume read_resume(FieldReader& in) {
  SubscribeMessage::Resume resume;
  resume.session = in.number<std::uint64_t>();
  resume.version = in.number<std::uint64_t>();
  resume.epoch = in.number<std::uint32_t>();
  in.require(in.number<std::uint32_t>() == 0);
  return resume;
}

double read_rate(FieldReader& in) {
  const double rate_hz = in.real(SubscribeMessage::kMaxPose_hz);
  in.require(rate_hz >= 0);
  return rate_hz;
}

}  // namespace

void encode(const SubscribeMessage& message, std::vector<std::byte>& out) {
  append_le(out, message.streams);
  append_le(out, std::uint32_t{0});
  append_le(out, message.pose_hz);
  append_le(out, message.scan_hz);
  append_resume(out, message.own);
  append_resume(out, message.team);
}

Result<SubscribeMessage> decode_subscribe(std::span<const std::byte> body) {
  FieldReader in(body);
  SubscribeMessage message;
  message.streams = in.up_to(kAllStreams);
  in.require(in.number<std::uint32_t>() == 0);
  message.pose_hz = read_rate(in);
  message.scan_hz = read_rate(in);
  message.own = read_resume(in);
  message.team = read_resume(in);
  if (!in.complete()) return in.error("not a subscription");
  return message;
}

}  // namespace cairn::clients
