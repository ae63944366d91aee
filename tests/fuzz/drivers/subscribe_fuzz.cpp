// SPDX-License-Identifier: Apache-2.0
// Any bytes that a client of robot.sock may send: a record, or a body alone. An error, or a subscription that asks for
// what there is and is the same when it is written and read again.
#include <algorithm>
#include <span>
#include <vector>

#include "drivers/clients/messages/subscribe.hpp"
#include "tests/fuzz/require.hpp"

namespace {

void look(std::span<const std::byte> body) {
  using namespace cairn;
  const auto message = clients::decode_subscribe(body);
  if (!message) return;
  require(message->pose_hz >= 0 && message->pose_hz <= clients::SubscribeMessage::kMaxPose_hz);
  require((message->streams & ~clients::kAllStreams) == 0);
  std::vector<std::byte> written;
  encode(*message, written);
  require(std::ranges::equal(written, body));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  if (const auto record = cairn::clients::decode_record(bytes)) look(record->body);
  look(bytes);
  return 0;
}
