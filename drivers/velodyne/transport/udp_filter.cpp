// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/transport/udp_filter.hpp"

#include <linux/filter.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>

#include <algorithm>

namespace cairn::velodyne {

bool admit_only(int socket, std::uint32_t address) {
  constexpr std::uint32_t kSourceInIpHeader = 12, kWhole = 0xFFFF;
  const auto at_ip_header = static_cast<std::uint32_t>(SKF_NET_OFF) + kSourceInIpHeader;
  std::array<sock_filter, 4> program{{{BPF_LD | BPF_W | BPF_ABS, 0, 0, at_ip_header},
                                      {BPF_JMP | BPF_JEQ | BPF_K, 0, 1, address},
                                      {BPF_RET | BPF_K, 0, 0, kWhole},
                                      {BPF_RET | BPF_K, 0, 0, 0}}};
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  return ::setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) == 0;
}

void admit_all(int socket) {
  const int unused = 0;
  (void)::setsockopt(socket, SOL_SOCKET, SO_DETACH_FILTER, &unused, sizeof unused);
}

std::optional<SocketMemory> socket_memory(int socket) {
  std::array<std::uint32_t, SK_MEMINFO_VARS> info{};
  ::socklen_t size = sizeof info;
  if (::getsockopt(socket, SOL_SOCKET, SO_MEMINFO, info.data(), &size) != 0 || size < sizeof info) return std::nullopt;
  return SocketMemory{info[SK_MEMINFO_RMEM_ALLOC], info[SK_MEMINFO_RCVBUF], info[SK_MEMINFO_DROPS]};
}

std::optional<std::uint32_t> SenderLearner::note(std::uint32_t address, bool valid, Time now) {
  if (address_) {
    if (*address_ == address) last_ = std::max(last_, now);
    return std::nullopt;
  }
  if (!valid) return std::nullopt;
  auto place =
      std::ranges::find_if(candidates_, [&](const Candidate& c) { return c.packets > 0 && c.address == address; });
  if (place == candidates_.end()) place = std::ranges::find(candidates_, 0, &Candidate::packets);
  if (place == candidates_.end()) {
    for (Candidate& c : candidates_) --c.packets;
    return std::nullopt;
  }
  place->address = address;
  if (++place->packets < kEnough) return std::nullopt;
  candidates_ = {};
  last_ = now;
  return address_ = address;
}

bool SenderLearner::forget_silent(Time now) {
  if (!address_ || now - last_ < kSilent) return false;
  address_.reset();
  return true;
}

}  // namespace cairn::velodyne
