// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/people.hpp"

#include <algorithm>

#include "drivers/clients/messages/field_reader.hpp"

namespace cairn::clients {
namespace {

constexpr std::uint32_t kSeen = 1;

void append(const PeopleMessage::Person& person, std::vector<std::byte>& out) {
  append_le(out, person.id);
  append_le(out, person.sightings);
  append_le(out, person.seen ? kSeen : 0U);
  append_le(out, std::uint32_t{0});
  for (const double x : person.position_odom) append_le(out, x);
  for (const double v : person.velocity_odom) append_le(out, v);
  append_le(out, person.covariance(0, 0));
  append_le(out, person.covariance(0, 1));
  append_le(out, person.covariance(1, 1));
}

PeopleMessage::Person read_person(FieldReader& in) {
  PeopleMessage::Person person;
  person.id = in.number<std::uint32_t>();
  person.sightings = in.number<std::uint32_t>();
  person.seen = in.up_to(kSeen) != 0;
  in.require(in.number<std::uint32_t>() == 0);
  for (double& x : person.position_odom) x = in.real();
  for (double& v : person.velocity_odom) v = in.real();
  person.covariance(0, 0) = in.real();
  person.covariance(0, 1) = person.covariance(1, 0) = in.real();
  person.covariance(1, 1) = in.real();
  in.require(person.covariance(0, 0) >= 0 && person.covariance(1, 1) >= 0);
  return person;
}

}  // namespace

void encode(const PeopleMessage& message, std::vector<std::byte>& out) {
  const std::size_t count = std::min(message.people.size(), PeopleMessage::kMost);
  append_time(out, message.stamp);
  append_le(out, message.epoch);
  append_le(out, static_cast<std::uint32_t>(count));
  append_le(out, message.robot);
  for (std::size_t i = 0; i < count; ++i) append(message.people[i], out);
}

Result<PeopleMessage> decode_people(std::span<const std::byte> body) {
  FieldReader in(body);
  PeopleMessage message;
  message.stamp = in.time();
  message.epoch = in.number<std::uint32_t>();
  const auto count = in.up_to(static_cast<std::uint32_t>(PeopleMessage::kMost));
  message.robot = in.number<std::uint64_t>();
  for (std::uint32_t i = 0; i < count && in.good(); ++i) message.people.push_back(read_person(in));
  if (!in.complete()) return in.error("not a list of people");
  return message;
}

}  // namespace cairn::clients
