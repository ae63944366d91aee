// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/robot_stream.hpp"

#include <algorithm>
#include <utility>

#include "hal/clock.hpp"

namespace cairn::client {
namespace {

using clients::LocalClient;
using clients::Record;
using clients::RecordKind;

constexpr Duration kRetry = std::chrono::milliseconds(50);  // from one attempt to find a core to the next
// Where many programs connect at once: so many further attempts, half a second in all.
constexpr Duration kStep = std::chrono::milliseconds(5);
constexpr int kCrowded = 100;

template <class Message>
Result<StreamMessage> as_message(Result<Message> message) {
  if (!message) return message.error();
  return StreamMessage(std::move(*message));
}

/// What a part completes; std::monostate: nothing yet.
template <class Assembly, class Part>
Result<StreamMessage> assembled(Assembly& assembly, Result<Part> part) {
  if (!part) return part.error();
  if (auto whole = assembly.take(std::move(*part))) return StreamMessage(std::move(*whole));
  return StreamMessage();
}

}  // namespace

Result<RobotStream> RobotStream::connect(const std::filesystem::path& socket, const SubscribeMessage& wants) {
  RobotStream stream(socket, wants);
  auto joined = stream.join();
  for (int i = 0; i < kCrowded && !joined && joined.error().code == Errc::kLimit; ++i) {
    LiveClock::wait_until(LiveClock().now() + kStep);
    joined = stream.join();
  }
  if (!joined) return joined.error();
  return stream;
}

Result<void> RobotStream::join() {
  auto link = LocalClient::connect(socket_);
  if (!link) return link.error();
  link_.emplace(std::move(*link));
  sequence_.reset();
  scans_ = {};
  pictures_ = {};
  (void)subscribe(wants_);  // a connection that ends here is found to have ended by next()
  return {};
}

bool RobotStream::subscribe(const SubscribeMessage& wants) {
  wants_ = wants;
  if (!link_) return false;
  std::vector<std::byte> record;
  clients::begin_record(RecordKind::kSubscribe, 0, record);
  encode(wants, record);
  clients::end_record(record);
  return link_->send(record);
}

void RobotStream::wait_for_core(Duration timeout) {
  const LiveClock clock;
  const Time end = clock.now() + timeout;
  for (Time now = clock.now(); !join() && now < end; now = clock.now())
    LiveClock::wait_until(std::min(end, now + kRetry));
}

Result<StreamMessage> RobotStream::next(Duration timeout) {
  if (!link_) {
    wait_for_core(timeout);
    return StreamMessage();
  }
  const LiveClock clock;
  const Time end = clock.now() + timeout;
  for (;;) {
    const auto got = link_->receive(bytes_, Record::kHeaderBytes + Record::kMaxBody, end - clock.now());
    if (got == LocalClient::Got::kNothing) return StreamMessage();
    if (got == LocalClient::Got::kEnd) {
      link_.reset();
      return StreamMessage(CoreGone{});
    }
    auto message = decode();
    if (!message || !std::holds_alternative<std::monostate>(*message)) return message;
  }
}

/// std::monostate: a record that is a part only, or of a kind that this release does not know.
Result<StreamMessage> RobotStream::decode() {
  const auto record = clients::decode_record(bytes_);
  if (!record) return record.error();
  if (sequence_) lost_ += record->sequence - *sequence_ - 1;  // modulo 2³²
  sequence_ = record->sequence;
  if (record->kind == RecordKind::kHello) return as_message(clients::decode_hello(record->body));
  if (record->kind == RecordKind::kPose) return as_message(clients::decode_pose(record->body));
  if (record->kind == RecordKind::kState) return as_message(clients::decode_state(record->body));
  if (record->kind == RecordKind::kTiles) return as_message(clients::decode_tiles(record->body));
  if (record->kind == RecordKind::kEvent) return as_message(clients::decode_event(record->body));
  if (record->kind == RecordKind::kPeople) return as_message(clients::decode_people(record->body));
  if (record->kind == RecordKind::kCamera) return as_message(clients::decode_camera(record->body));
  if (record->kind == RecordKind::kWheels) return as_message(clients::decode_wheels(record->body));
  if (record->kind == RecordKind::kScan) return assembled(scans_, clients::decode_scan(record->body));
  if (record->kind == RecordKind::kThermal) return assembled(thermals_, clients::decode_thermal(record->body));
  if (record->kind == RecordKind::kPicture) return assembled(pictures_, clients::decode_picture(record->body));
  return StreamMessage();
}

}  // namespace cairn::client
