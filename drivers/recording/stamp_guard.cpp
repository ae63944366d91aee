// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/stamp_guard.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace cairn::recording {
namespace {

bool near(Time a, Time b) { return a - b <= StampGuard::kFar && b - a <= StampGuard::kFar; }

}  // namespace

void StampGuard::push(Time stamp, std::optional<std::uint64_t> offset) { open_.push_back({stamp, offset}); }

std::optional<StampGuard::Verdict> StampGuard::pop() {
  if (open_.empty() || (!ended_ && open_.size() <= kAhead)) return std::nullopt;
  const Stamp oldest = open_.front();
  open_.pop_front();
  const Verdict verdict{oldest.time, is_absurd(oldest.time)};
  if (!verdict.absurd) {
    last_ = oldest.time;
  } else if (found_.count++ == 0) {
    const Time beside = last_ ? *last_ : open_.front().time;
    found_ = {1, judged_, oldest.offset, oldest.time - beside};
  }
  ++judged_;
  return verdict;
}

/// The packets behind decide: do they stay where this one is, or where the one before was?
bool StampGuard::is_absurd(Time stamp) const {
  if (last_ && near(stamp, *last_)) return false;
  const auto stay = std::ranges::count_if(open_, [&](const Stamp& s) { return near(s.time, stamp); });
  if (!last_) return stay == 0 && open_.size() > 1;
  return stay <= std::ranges::count_if(open_, [&](const Stamp& s) { return near(s.time, *last_); });
}

std::optional<Error> StampGuard::to_error(const std::string& file, const char* what_now) const {
  if (found_.count == 0) return std::nullopt;
  const std::int64_t seconds = found_.first_distance / std::chrono::seconds(1);
  return Error{Errc::kMalformed, "stamps of packets are absurd", file, found_.first_offset,
               std::to_string(found_.count) + " in all, the first is packet " + std::to_string(found_.first_packet) +
                   ", " + std::to_string(std::abs(seconds)) + " s " + (seconds < 0 ? "before" : "after") +
                   " the packet beside it; " + what_now + ". Check the clock of the computer that recorded them"};
}

GuardedSource::GuardedSource(std::unique_ptr<Source> recorded, std::string file, Offset offset)
    : recorded_(std::move(recorded)),
      file_(std::move(file)),
      offset_(std::move(offset)),
      ring_(StampGuard::kAhead + 1) {}

Result<Poll> GuardedSource::next(Packet& packet, Duration timeout) {
  for (;;) {
    if (const auto verdict = guard_.pop()) {
      std::swap(packet, ring_[first_]);
      first_ = (first_ + 1) % ring_.size();
      --held_;
      packet.sequence -= guard_.found().count;  // what is set aside is not lost
      if (!verdict->absurd) return Poll::kPacket;
    } else if (ended_) {
      const auto error = guard_.to_error(file_, "they are set aside");
      if (error && !std::exchange(told_, true)) return *error;
      return Poll::kEnd;
    } else {
      Packet& place = ring_[(first_ + held_) % ring_.size()];
      const auto poll = recorded_->next(place, timeout);
      if (!poll || *poll == Poll::kTimeout) return poll;
      if (*poll == Poll::kEnd) {
        ended_ = true;
        guard_.end();
        continue;
      }
      guard_.push(place.arrival, offset_ ? offset_() : std::nullopt);
      ++held_;
    }
  }
}

}  // namespace cairn::recording
