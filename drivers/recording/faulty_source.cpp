// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/faulty_source.hpp"

#include <algorithm>
#include <utility>

namespace cairn::recording {

bool FaultySource::happens(double share) {
  // Drawn even for a share of zero: turning one fault on leaves the others where they were.
  constexpr double kSteps = 9007199254740992.0;  // 2^53
  return static_cast<double>(random_() >> 11U) / kSteps < share;
}

bool FaultySource::in_spell(Time arrival) const {
  if (faults_.period <= Duration{} || arrival < *first_) return false;
  // The end of each period, so that a recording begins with what is good.
  return (arrival - *first_) % faults_.period >= faults_.period - faults_.freeze;
}

void FaultySource::damage(Packet& packet) {
  const bool cut = happens(faults_.cut), flip = happens(faults_.flip), extend = happens(faults_.extend);
  const std::uint64_t where = random_();
  if (packet.bytes.empty()) return;
  if (cut) {
    packet.bytes.resize(where % packet.bytes.size());
    packet.truncated = true;
    ++counters_.cut;
  } else if (flip) {
    packet.bytes[where / 8 % packet.bytes.size()] ^= static_cast<std::byte>(1U << (where % 8));
    ++counters_.flipped;
  } else if (extend) {
    packet.bytes.resize(packet.bytes.size() + 1 + where % 64, static_cast<std::byte>(where >> 8U));
    ++counters_.extended;
  }
}

bool FaultySource::pass_spell(Packet& packet) {
  if (!in_spell(packet.arrival)) {
    // What waited arrives with the first packet after the spell.
    for (Packet& late : burst_) out_.push_back(std::move(late)), out_.back().arrival = packet.arrival;
    burst_.clear();
    connected_ = true;
    if (faults_.spell == Spell::kStuck) good_ = packet;
    return true;
  }
  switch (faults_.spell) {
    case Spell::kStuck:
      if (good_) packet.bytes = good_->bytes;
      ++counters_.stuck;
      return true;
    case Spell::kBurst:
      if (burst_.size() < kMaxWaiting) burst_.push_back(packet);
      ++counters_.burst;
      return false;
    case Spell::kDisconnect:
      complain_ = complain_ || connected_;
      counters_.disconnects += connected_ ? 1 : 0;
      connected_ = false;
      break;
    case Spell::kSilence:
      break;
  }
  ++counters_.frozen;
  return false;
}

bool FaultySource::pass(Packet& packet) {
  const bool drop = happens(faults_.drop), repeat = happens(faults_.repeat), swap = happens(faults_.swap);
  damage(packet);
  const bool delay = happens(faults_.delay);
  if (!pass_spell(packet)) return false;
  if (drop) {
    ++counters_.dropped;
    return false;
  }
  if (delay && delayed_.size() < kMaxWaiting) {
    packet.arrival += faults_.delay_by;
    const auto later = [](const Packet& a, const Packet& b) { return a.arrival < b.arrival; };
    delayed_.insert(std::upper_bound(delayed_.begin(), delayed_.end(), packet, later), packet);
    ++counters_.delayed;
    return false;
  }
  if (swap && !held_) {
    held_ = packet;
    ++counters_.swapped;
    return false;
  }
  if (repeat) {
    out_.push_back(packet);
    ++counters_.repeated;
  }
  return true;
}

void FaultySource::take(Packet& packet) {
  ++counters_.packets;
  if (!first_) first_ = packet.arrival;
  release_until(packet.arrival);
  if (faults_.only && packet.source != *faults_.only) return out_.push_back(packet);
  if (faults_.shift != Duration{} && packet.arrival - *first_ >= faults_.shift_after) {
    packet.arrival += faults_.shift;
    ++counters_.shifted;
  }
  const bool waiting = held_.has_value();
  if (!pass(packet)) return;
  out_.push_back(packet);
  if (waiting) out_.push_back(*std::exchange(held_, std::nullopt));
}

void FaultySource::release_until(Time arrival) {
  const auto due = std::find_if(delayed_.begin(), delayed_.end(), [&](const Packet& p) { return p.arrival > arrival; });
  std::move(delayed_.begin(), due, std::back_inserter(out_));
  delayed_.erase(delayed_.begin(), due);
}

void FaultySource::release_all() {
  release_until(Time::max());
  std::move(burst_.begin(), burst_.end(), std::back_inserter(out_));
  burst_.clear();
  if (held_) out_.push_back(*std::exchange(held_, std::nullopt));
}

Result<Poll> FaultySource::next(Packet& packet, Duration timeout) {
  while (out_.empty()) {
    if (std::exchange(complain_, false)) return Error{Errc::kLinkDown, "the device is gone"};
    const auto poll = inner_.next(packet, timeout);
    if (poll && *poll == Poll::kEnd) release_all();
    if (!poll || *poll == Poll::kTimeout || (*poll == Poll::kEnd && out_.empty())) return poll;
    if (*poll == Poll::kPacket) take(packet);
  }
  packet = std::move(out_.front());
  out_.pop_front();
  return Poll::kPacket;
}

}  // namespace cairn::recording
