// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/command.hpp"

#include <array>
#include <numbers>

#include "drivers/clients/messages/record.hpp"
#include "hal/bytes.hpp"

namespace cairn::clients {
namespace {

constexpr std::array<std::string_view, 8> kVerbs{"", "velocity", "hold", "arm", "disarm", "stop", "release", "place"};
constexpr std::array<std::string_view, 9> kOutcomes{"",      "done",    "limited", "held",    "not_holder",
                                                    "stale", "invalid", "refused", "replaced"};

/// The code as one of the enumeration's; they count from 1.
template <class Enum, class Names>
std::optional<Enum> known(std::optional<std::uint8_t> code, const Names& names) {
  if (!code || *code < 1 || *code >= names.size()) return std::nullopt;
  return static_cast<Enum>(*code);
}

Error malformed(std::string_view cause) { return {Errc::kMalformed, cause, {}, {}, {}}; }

void append_placement(std::vector<std::byte>& out, const Placement& place) {
  append_text(out, place.frame);
  for (const double value : {place.x, place.y, place.yaw, place.sigma_m, place.sigma_rad}) append_le(out, value);
}

std::optional<Placement> read_placement(ByteReader& in) {
  const auto frame = read_text<32>(in);
  const auto x = in.read<double>(), y = in.read<double>(), yaw = in.read<double>();
  const auto sigma_m = in.read<double>(), sigma_rad = in.read<double>();
  if (!frame || !sigma_rad) return std::nullopt;
  return Placement{*frame, *x, *y, *yaw, *sigma_m, *sigma_rad};
}

}  // namespace

bool Placement::possible() const {
  const auto within = [](double value, double least, double most) { return value >= least && value <= most; };
  return within(x, -kFarthest_m, kFarthest_m) && within(y, -kFarthest_m, kFarthest_m) &&
         within(yaw, -2 * std::numbers::pi, 2 * std::numbers::pi) && within(sigma_m, kLeastSigma_m, kMostSigma_m) &&
         within(sigma_rad, kLeastSigma_rad, std::numbers::pi);
}

std::string_view to_string(Command::Verb verb) { return kVerbs.at(static_cast<std::size_t>(verb)); }
std::string_view to_string(Answer::Outcome outcome) { return kOutcomes.at(static_cast<std::size_t>(outcome)); }

void encode(const Command& command, std::vector<std::byte>& out) {
  begin_record(RecordKind::kCommand, command.number, out);
  append_le(out, static_cast<std::uint8_t>(command.verb));
  append_le(out, static_cast<std::int64_t>(command.sent.time_since_epoch().count()));
  append_le(out, static_cast<std::int64_t>(command.valid_for.count()));
  append_le(out, command.v);
  append_le(out, command.w);
  append_le(out, command.epoch);
  append_text(out, command.who);
  if (command.verb == Command::Verb::kPlace) append_placement(out, command.place);
  end_record(out);
}

Result<Command> decode_command(std::span<const std::byte> message) {
  const auto record = decode_record(message);
  if (!record) return record.error();
  if (record->kind != RecordKind::kCommand) return malformed("a record of another kind");
  ByteReader in(record->body);
  const auto verb = known<Command::Verb>(in.read<std::uint8_t>(), kVerbs);
  const auto sent = in.read<std::int64_t>(), valid_for = in.read<std::int64_t>();
  const auto v = in.read<double>(), w = in.read<double>();
  const auto epoch = in.read<std::uint32_t>();
  const auto who = read_text<32>(in);
  const bool places = verb == Command::Verb::kPlace;
  const auto place = places ? read_placement(in) : std::optional(Placement{});
  if (!verb || !sent || !valid_for || !v || !w || !epoch || !who || !place || in.remaining() != 0)
    return malformed("no command can be like this");
  return Command{*verb, record->sequence, Time{Duration{*sent}}, Duration{*valid_for}, *v, *w, *epoch, *who, *place};
}

void encode(const Answer& answer, std::uint32_t sequence, std::vector<std::byte>& out) {
  begin_record(answer.number == 0 ? RecordKind::kGreeting : RecordKind::kAnswer, sequence, out);
  append_le(out, static_cast<std::uint8_t>(answer.outcome));
  append_le(out, static_cast<std::uint8_t>(answer.stopped));
  append_le(out, answer.number);
  append_le(out, answer.epoch);
  append_le(out, answer.v);
  append_le(out, answer.w);
  append_text(out, answer.holder);
  append_text(out, answer.why);
  end_record(out);
}

Result<Answer> decode_answer(std::span<const std::byte> message) {
  const auto record = decode_record(message);
  if (!record) return record.error();
  if (record->kind != RecordKind::kAnswer && record->kind != RecordKind::kGreeting)
    return malformed("a record of another kind");
  ByteReader in(record->body);
  const auto outcome = known<Answer::Outcome>(in.read<std::uint8_t>(), kOutcomes);
  const auto stopped = in.read<std::uint8_t>();
  const auto number = in.read<std::uint32_t>(), epoch = in.read<std::uint32_t>();
  const auto v = in.read<double>(), w = in.read<double>();
  const auto holder = read_text<32>(in);
  const auto why = read_text<200>(in);
  if (!outcome || !stopped || *stopped > 1 || !number || !epoch || !v || !w || !holder || !why || in.remaining() != 0)
    return malformed("no answer can be like this");
  return Answer{*outcome, *number, *epoch, *stopped != 0, *v, *w, *holder, *why};
}

}  // namespace cairn::clients
