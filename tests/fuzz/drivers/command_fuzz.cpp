// SPDX-License-Identifier: Apache-2.0
// Any bytes as a command or an answer: refused, or written again as they were. The checksum is mended first, so that
// the body is reached.
#include <cstring>

#include "drivers/clients/messages/command.hpp"
#include "drivers/clients/messages/record.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using namespace cairn;

void same(std::span<const std::byte> bytes, const std::vector<std::byte>& again) {
  require(again.size() == bytes.size() && std::memcmp(again.data(), bytes.data(), bytes.size()) == 0);
}

void decode(std::span<const std::byte> bytes) {
  std::vector<std::byte> again;
  if (const auto command = clients::decode_command(bytes)) {
    clients::encode(*command, again);
    same(bytes, again);
  }
  if (const auto answer = clients::decode_answer(bytes)) {
    const auto record = clients::decode_record(bytes);
    clients::encode(*answer, record->sequence, again);
    const bool greeting = record->kind == clients::RecordKind::kGreeting;
    if (greeting == (answer->number == 0)) same(bytes, again);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  std::vector<std::byte> bytes(size);
  if (size > 0) std::memcpy(bytes.data(), data, size);
  decode(bytes);
  if (size < clients::Record::kHeaderBytes) return 0;
  clients::end_record(bytes);
  decode(bytes);
  return 0;
}
