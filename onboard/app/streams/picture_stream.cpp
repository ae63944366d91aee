// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/picture_stream.hpp"

#include "drivers/clients/messages/picture.hpp"

namespace cairn::app {

void PictureStream::serve(ClientHub& hub, SpscQueue<Packet>& pictures, Duration latency, std::size_t& records) {
  latency_ = latency;
  for (; const Packet* picture = pictures.front(); pictures.pop(), begun_ = false) {
    if (!begun_) begin(hub, *picture);
    bool all = true;
    for (StreamClient& client : hub.clients()) all = send(hub, client, *picture, records) && all;
    if (!all && pictures.size() < 2) return;
    for (StreamClient& client : hub.clients())
      if (client.pictures[camera_].bytes) ++client.sequence;  // a part is lost, and the rest is of no use
  }
}

void PictureStream::begin(ClientHub& hub, const Packet& picture) {
  begun_ = true;
  for (StreamClient& client : hub.clients()) {
    PictureCursor& cursor = client.pictures[camera_];
    cursor.bytes.reset();
    if (client.wants.wants(clients::Stream::kPictures) && cursor.limit.due(picture.arrival)) cursor.bytes = 0;
  }
}

/// True: the client has the picture, or does not want it.
bool PictureStream::send(ClientHub& hub, StreamClient& client, const Packet& picture, std::size_t& records) {
  auto& sent = client.pictures[camera_].bytes;
  if (!sent) return true;
  clients::PicturePart part{.stamp = picture.arrival - latency_, .camera = camera_, .first = *sent};
  do {
    if (records == 0) return false;
    --records;
    clients::begin_record(clients::RecordKind::kPicture, client.sequence, record_);
    const std::uint32_t taken = encode(part, picture.payload(), record_);
    clients::end_record(record_);
    if (!hub.try_send(client, record_)) return false;
    sent = part.first += taken;
  } while (part.first < picture.bytes.size());
  sent.reset();
  return true;
}

}  // namespace cairn::app
