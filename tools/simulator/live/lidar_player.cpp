// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/lidar_player.hpp"

namespace cairn::simulator {

Result<void> LidarPlayer::play(Time known) {
  leave_out(known);
  const std::uint64_t n = next_;
  if (lidar_.arrival(n) > known) return {};
  ++next_;
  Result<void> positioned;
  if (n % Lidar::kPositionEvery == 0) positioned = send_position(lidar_.arrival(n));
  (void)lidar_.fill(n, data_);
  auto sent = wire_(Kind::kData, data_);
  const Duration late = clock_.now() - lidar_.arrival(n);
  late_.record(late);
  lateness_.sent(late);
  ++(sent ? counters_.data_packets : counters_.refused);
  return sent ? positioned : sent;
}

void LidarPlayer::leave_out(Time known) {
  if (known - lidar_.arrival(next_) <= kMostBehind) return;
  std::uint64_t left_out = 0;
  for (; lidar_.arrival(next_ + 1) <= known; ++next_) ++left_out;
  counters_.left_out += left_out;
  lateness_.left_out(left_out);
}

Result<void> LidarPlayer::send_position(Time at) {
  lidar_.fill_position(at, position_);
  auto sent = wire_(Kind::kPosition, position_);
  ++(sent ? counters_.position_packets : counters_.refused);
  return sent;
}

}  // namespace cairn::simulator
