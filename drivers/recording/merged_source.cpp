// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/merged_source.hpp"

#include <tuple>
#include <utility>

namespace cairn::recording {

MergedSource::MergedSource(std::vector<std::unique_ptr<Source>> sources) : heads_(sources.size()) {
  for (std::size_t i = 0; i < sources.size(); ++i) heads_[i].source = std::move(sources[i]);
}

bool MergedSource::earlier(const Head& a, const Head& b) {
  return std::tie(a.packet.arrival, a.packet.source, a.packet.sequence) <
         std::tie(b.packet.arrival, b.packet.source, b.packet.sequence);
}

Result<Poll> MergedSource::next(Packet& packet, Duration timeout) {
  Head* first = nullptr;
  for (std::size_t i = 0; i < heads_.size(); ++i) {
    Head& head = heads_[i];
    if (!head.filled && !head.ended) {
      const auto poll = head.source->next(head.packet, timeout);
      if (!poll) return poll.error();
      if (*poll == Poll::kTimeout) return Poll::kTimeout;  // what it will bring may be the earliest
      head.filled = *poll == Poll::kPacket;
      head.ended = *poll == Poll::kEnd;
      head.packet.source = static_cast<SourceId>(i);
    }
    if (head.filled && (first == nullptr || earlier(head, *first))) first = &head;
  }
  if (first == nullptr) return Poll::kEnd;
  std::swap(packet, first->packet);
  first->filled = false;
  return Poll::kPacket;
}

}  // namespace cairn::recording
