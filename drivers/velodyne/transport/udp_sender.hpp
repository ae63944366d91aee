// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "hal/result.hpp"

namespace cairn::velodyne {

/// Sends datagrams as a sensor does. `cairn send` uses it for a robot on the bench.
class UdpSender {
 public:
  /// `address`: IPv4, numbers and dots. Errors: kInvalidConfig, kIo.
  static Result<std::unique_ptr<UdpSender>> open(const std::string& address);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// To `port` of the address. Error kIo: the network refuses.
  Result<void> send(std::span<const std::byte> payload, std::uint16_t port);

 private:
  UdpSender(int fd, std::uint32_t address) : fd_(fd), address_(address) {}
  int fd_;
  std::uint32_t address_;  // network byte order
};

}  // namespace cairn::velodyne
