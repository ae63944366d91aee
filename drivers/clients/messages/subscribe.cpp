// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/subscribe.hpp"

#include <cmath>

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

double checked_rate(FieldReader& in, double rate_hz) {
  in.require(std::isfinite(rate_hz) && !std::signbit(rate_hz) && rate_hz <= SubscribeMessage::kMaxPose_hz);
  return in.good() ? rate_hz : 0;
}

}  // namespace

void encode(const SubscribeMessage& message, std::vector<std::byte>& out) {
  append_le(out, message.streams);
  append_le(out, message.picture_hz);
  append_le(out, message.pose_hz);
  append_le(out, message.scan_hz);
  append_resume(out, message.own);
  append_resume(out, message.team);
}

Result<SubscribeMessage> decode_subscribe(std::span<const std::byte> body) {
  FieldReader in(body);
  SubscribeMessage message;
  message.streams = in.up_to(kAllStreams);
  message.picture_hz = static_cast<float>(checked_rate(in, in.number<float>()));
  message.pose_hz = checked_rate(in, in.number<double>());
  message.scan_hz = checked_rate(in, in.number<double>());
  message.own = read_resume(in);
  message.team = read_resume(in);
  if (!in.complete()) return in.error("not a subscription");
  return message;
}

}  // namespace cairn::clients
