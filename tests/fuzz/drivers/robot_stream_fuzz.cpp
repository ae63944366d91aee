// SPDX-License-Identifier: Apache-2.0
// Any bytes that a core may send: a record, or its kind (1 byte) and body. An error, or a message that is bounded and
// is the same when it is written and read again.
#include <algorithm>
#include <span>
#include <vector>

#include "drivers/clients/messages/camera.hpp"
#include "drivers/clients/messages/clouds/scan.hpp"
#include "drivers/clients/messages/clouds/thermal.hpp"
#include "drivers/clients/messages/event.hpp"
#include "drivers/clients/messages/hello.hpp"
#include "drivers/clients/messages/people.hpp"
#include "drivers/clients/messages/picture.hpp"
#include "drivers/clients/messages/pose.hpp"
#include "drivers/clients/messages/state.hpp"
#include "drivers/clients/messages/tiles.hpp"
#include "drivers/clients/messages/wheels.hpp"
#include "tests/fuzz/require.hpp"

namespace cairn::clients {
namespace {

using Body = std::span<const std::byte>;

std::vector<std::byte> written(const TilesMessage& message) {
  std::vector<std::byte> out;
  TilesWriter writer(message, 0, out);
  for (const TilesMessage::Tile& tile : message.tiles) require(writer.add(tile));
  writer.finish(message.caught_up);
  const auto record = decode_record(out);
  require(record.has_value());
  return {record->body.begin(), record->body.end()};
}
std::vector<std::byte> written(const ScanPart& part) {
  std::vector<Eigen::Vector3f> points(part.total, Eigen::Vector3f::Zero());
  std::ranges::copy(part.points_base, points.begin() + part.first);
  std::vector<std::byte> out;
  encode(part, points, out);
  return out;
}
std::vector<std::byte> written(const ThermalPart& part) {
  std::vector<ThermalPoint> points(part.total);
  std::ranges::copy(part.points, points.begin() + part.first);
  std::vector<std::byte> out;
  encode(part, points, out);
  return out;
}
std::vector<std::byte> written(const PicturePart& part) {
  std::vector<std::byte> bytes(part.total);
  std::ranges::copy(part.bytes, bytes.begin() + part.first);
  std::vector<std::byte> out;
  encode(part, bytes, out);
  return out;
}
template <class Message>
std::vector<std::byte> written(const Message& message) {
  std::vector<std::byte> out;
  encode(message, out);
  return out;
}

template <class Decode>
void look(Body body, Decode decode) {
  const auto message = decode(body);
  if (!message) return;
  const auto bytes = written(*message);
  require(bytes.size() <= Record::kMaxBody && decode(Body(bytes)).has_value());
}

void look(RecordKind kind, Body body) {
  if (body.size() > Record::kMaxBody) return;
  if (kind == RecordKind::kHello) look(body, decode_hello);
  if (kind == RecordKind::kPose) look(body, decode_pose);
  if (kind == RecordKind::kState) look(body, decode_state);
  if (kind == RecordKind::kTiles) look(body, decode_tiles);
  if (kind == RecordKind::kScan) look(body, decode_scan);
  if (kind == RecordKind::kThermal) look(body, decode_thermal);
  if (kind == RecordKind::kEvent) look(body, decode_event);
  if (kind == RecordKind::kPeople) look(body, decode_people);
  if (kind == RecordKind::kCamera) look(body, decode_camera);
  if (kind == RecordKind::kPicture) look(body, decode_picture);
  if (kind == RecordKind::kWheels) look(body, decode_wheels);
}

}  // namespace
}  // namespace cairn::clients

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn::clients;
  const Body bytes = std::as_bytes(std::span(data, size));
  if (const auto record = decode_record(bytes)) look(record->kind, record->body);
  if (size > 0) look(static_cast<RecordKind>(data[0]), bytes.subspan(1));
  return 0;
}
