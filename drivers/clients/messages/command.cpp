// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/command.hpp"

#include <array>

#include "drivers/clients/messages/record.hpp"
#include "hal/bytes.hpp"

namespace cairn::clients {
namespace {

constexpr std::array<std::string_view, 7> kVerbs{"", "velocity", "hold", "arm", "disarm", "stop", "release"};
constexpr std::array<std::string_view, 9> kOutcomes{"",      "done",    "limited", "held",    "not_holder",
                                                    "stale", "invalid", "refused", "replaced"};

/// The code as one of the enumeration's; they count from 1.
template <class Enum, class Names>
std::optional<Enum> known(std::optional<std::uint8_t> code, const Names& names) {
  if (!code || *code < 1 || *code >= names.size()) return std::nullopt;
  return static_cast<Enum>(*code);
}

Error malformed(std::string_view cause) { return {Errc::kMalformed, cause, {}, {}, {}}; }

}  // namespace

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
  if (!verb || !sent || !valid_for || !v || !w || !epoch || !who || in.remaining() != 0)
    return malformed("no command can be like this");
  return Command{*verb, record->sequence, Time{Duration{*sent}}, Duration{*valid_for}, *v, *w, *epoch, *who};
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
