// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/faulty_source.hpp"

#include <utility>

namespace cairn::recording {

bool FaultySource::happens(double share) {
  // Drawn even for a share of zero: turning one fault on leaves the others where they were.
  constexpr double kSteps = 9007199254740992.0;  // 2^53
  return static_cast<double>(random_() >> 11U) / kSteps < share;
}

bool FaultySource::is_frozen(Time arrival) {
  if (!first_) first_ = arrival;
  if (faults_.period <= Duration{} || arrival < *first_) return false;
  // The end of each period, so that a recording begins with what is good.
  return (arrival - *first_) % faults_.period >= faults_.period - faults_.freeze;
}

void FaultySource::damage(Packet& packet) {
  const bool cut = happens(faults_.cut), flip = happens(faults_.flip);
  const std::uint64_t where = random_();
  if (packet.bytes.empty()) return;
  if (cut) {
    packet.bytes.resize(where % packet.bytes.size());
    packet.truncated = true;
    ++counters_.cut;
  } else if (flip) {
    packet.bytes[where / 8 % packet.bytes.size()] ^= static_cast<std::byte>(1U << (where % 8));
    ++counters_.flipped;
  }
}

bool FaultySource::pass(Packet& packet) {
  ++counters_.packets;
  if (faults_.only && packet.source != *faults_.only) return true;
  const bool drop = happens(faults_.drop), repeat = happens(faults_.repeat), swap = happens(faults_.swap);
  damage(packet);
  if (is_frozen(packet.arrival)) {
    ++counters_.frozen;
    return false;
  }
  if (drop) {
    ++counters_.dropped;
    return false;
  }
  if (swap && !held_) {
    held_ = packet;
    ++counters_.swapped;
    return false;
  }
  if (repeat) {
    again_ = packet;
    ++counters_.repeated;
  }
  return true;
}

Result<Poll> FaultySource::next(Packet& packet, Duration timeout) {
  if (again_) {
    packet = *std::exchange(again_, std::nullopt);
    return Poll::kPacket;
  }
  for (;;) {
    const auto poll = inner_.next(packet, timeout);
    if (poll && *poll == Poll::kEnd && held_) {
      packet = *std::exchange(held_, std::nullopt);
      return Poll::kPacket;
    }
    if (!poll || *poll != Poll::kPacket) return poll;
    const bool waiting = held_.has_value();
    if (!pass(packet)) continue;
    if (waiting && !again_) again_ = std::exchange(held_, std::nullopt);
    return Poll::kPacket;
  }
}

}  // namespace cairn::recording
