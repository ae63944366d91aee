// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/tx_queue.hpp"

#include <algorithm>

namespace cairn::drive {
namespace {

bool replaces(const CanFrame& newer, const CanFrame& older) {
  constexpr std::uint32_t kNmtId = 0;
  return newer.id == older.id && (newer.id != kNmtId || newer.data[1] == older.data[1]);
}

}  // namespace

bool TxQueue::push(const CanFrame& frame) {
  const auto end = frames_.begin() + static_cast<std::ptrdiff_t>(size_);
  const auto same = std::find_if(frames_.begin(), end, [&](const CanFrame& f) { return replaces(frame, f); });
  if (same != end) return *same = frame, true;
  if (size_ == kCapacity) return ++dropped_, false;
  frames_[size_++] = frame;
  return true;
}

void TxQueue::drop_front(std::size_t n) {
  n = std::min(n, size_);
  std::copy(frames_.begin() + static_cast<std::ptrdiff_t>(n), frames_.begin() + static_cast<std::ptrdiff_t>(size_),
            frames_.begin());
  size_ -= n;
}

}  // namespace cairn::drive
