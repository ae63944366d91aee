// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "drivers/velodyne/config.hpp"
#include "drivers/velodyne/models.hpp"
#include "drivers/velodyne/transport/rate_window.hpp"
#include "drivers/velodyne/transport/udp_filter.hpp"
#include "hal/clock.hpp"
#include "hal/ports.hpp"

struct msghdr;

namespace cairn::velodyne {

/// A live sensor: its data and position datagrams as they arrive, with the receive stamps of the kernel. Allocates
/// nothing once the packet has grown.
///
/// Only the sensor's own datagrams are delivered: those of Config::source_address or, if that is empty, of the first
/// sender of valid packets (SenderLearner). The kernel drops all others, so a flood of them costs no packet of the
/// sensor. Until an address is known, or known again after the sensor was silent, all senders are heard.
class UdpSource final : public Source {
 public:
  /// What happened to the datagrams.
  struct Counters {
    std::uint64_t delivered = 0;     ///< as packets
    std::uint64_t foreign = 0;       ///< of another sender than the sensor, dropped here
    std::uint64_t filtered = 0;      ///< the same, dropped in the kernel before they could fill the buffer
    std::uint64_t flooded = 0;       ///< above Config::max_packets_per_s
    std::uint64_t truncated = 0;     ///< longer than any Velodyne datagram; delivered, but marked
    std::uint64_t unstamped = 0;     ///< without a usable kernel stamp: stamped when read
    std::uint64_t kernel_drops = 0;  ///< the receive buffer was full
    int receive_buffer_bytes = 0;    ///< granted by the kernel for one socket, its own bookkeeping included
  };

  /// Binds Config::data_port and Config::position_port (0: any free one) on Config::bind_address. `clock` must outlive
  /// the source. Errors: kInvalidConfig, kIo with the port and the remedy.
  static Result<std::unique_ptr<UdpSource>> open(const Config& config, SourceId source, const Clock& clock);

  /// Reads at most kMaxLooked datagrams, so a flood cannot hold the caller. Packet::channel is the destination port.
  Result<Poll> next(Packet& packet, Duration timeout) override;

  [[nodiscard]] const Counters& counters() const { return counters_; }
  /// Of the sensor, IPv4 in host byte order; none while it is not known.
  [[nodiscard]] std::optional<std::uint32_t> sender() const;
  [[nodiscard]] std::uint16_t data_port() const { return sockets_[0].port; }
  [[nodiscard]] std::uint16_t position_port() const { return sockets_[1].port; }

  static constexpr std::size_t kMaxDatagram = 2048;
  static constexpr int kMaxLooked = 64;

 private:
  /// Owns a file descriptor.
  struct Socket {
    Socket() = default;
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;
    ~Socket();
    int fd = -1;
    std::uint16_t port = 0;
    std::uint32_t drops = 0;  // since the socket was made, as far as they are counted
  };
  enum class Received : std::uint8_t { kWanted, kUnwanted, kNothing };

  UdpSource(const Config& config, SourceId source, const Clock& clock);
  Result<void> bind(Socket& socket, int port, const Config& config);
  Result<Received> receive(Socket& socket, Packet& packet);
  Result<Received> receive_any(Packet& packet);
  void read_stamps(msghdr& message, Packet& packet);
  void learn(std::uint32_t sender, const Packet& packet);
  void hear_only(std::optional<std::uint32_t> sender);
  void count_drops();

  const Clock& clock_;
  SourceId source_;
  const Model& model_;
  std::optional<std::uint32_t> source_address_;  // of the configuration, host byte order
  SenderLearner learner_;                        // without it
  bool filters_ = false;                         // the kernel does
  RateWindow rate_;
  std::array<Socket, 2> sockets_;  // data, position
  std::size_t turn_ = 0;           // which socket is read first, so that none starves
  int until_count_ = 0;            // datagrams, until drops are counted again
  Counters counters_;
};

}  // namespace cairn::velodyne
