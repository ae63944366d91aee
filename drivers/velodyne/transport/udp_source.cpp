// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/transport/udp_source.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <span>
#include <utility>

#include "drivers/velodyne/data_packet.hpp"

namespace cairn::velodyne {
namespace {

Error io_error(std::string_view cause, int port) {
  const int why = errno;
  std::string detail = std::strerror(why);
  if (why == EADDRINUSE) detail += "; another program listens there (ss -lunp shows which): stop it or change the port";
  if (why == EADDRNOTAVAIL) detail += "; set bind_address to an address of this computer, or leave it empty";
  return {Errc::kIo, cause, "UDP port " + std::to_string(port), {}, std::move(detail)};
}

sockaddr_in address_of(const std::string& text, int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  if (!text.empty()) inet_pton(AF_INET, text.c_str(), &address.sin_addr);
  return address;
}

bool set_option(int fd, int option, int value) { return setsockopt(fd, SOL_SOCKET, option, &value, sizeof value) == 0; }

/// True when a datagram is there. An interrupted wait counts as one that was too short.
bool wait_for(std::span<pollfd> fds, Duration timeout) {
  const auto ns = std::max<std::int64_t>(0, timeout.count());
  const timespec limit{ns / 1'000'000'000, ns % 1'000'000'000};
  return ppoll(fds.data(), fds.size(), &limit, nullptr) > 0;
}

}  // namespace

UdpSource::Socket::~Socket() {
  if (fd >= 0) ::close(fd);
}

Result<std::unique_ptr<UdpSource>> UdpSource::open(const Config& config, SourceId source, const Clock& clock) {
  if (auto sound = check(config); !sound) return sound.error();
  std::unique_ptr<UdpSource> made(new UdpSource(config, source, clock));
  if (auto bound = made->bind(made->sockets_[0], config.data_port, config); !bound) return bound.error();
  if (auto bound = made->bind(made->sockets_[1], config.position_port, config); !bound) return bound.error();
  made->hear_only(made->source_address_);
  return made;
}

UdpSource::UdpSource(const Config& config, SourceId source, const Clock& clock)
    : clock_(clock), source_(source), model_(*find_model(config.model)), rate_(config.max_packets_per_s) {
  if (!config.source_address.empty()) source_address_ = ntohl(address_of(config.source_address, 0).sin_addr.s_addr);
}

Result<void> UdpSource::bind(Socket& socket, int port, const Config& config) {
  socket.fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket.fd < 0) return io_error("cannot make a socket", port);
  // The first needs CAP_NET_ADMIN and passes net.core.rmem_max; the second grants what that allows.
  if (!set_option(socket.fd, SO_RCVBUFFORCE, config.receive_buffer_bytes))
    set_option(socket.fd, SO_RCVBUF, config.receive_buffer_bytes);
  socklen_t size = sizeof counters_.receive_buffer_bytes;
  getsockopt(socket.fd, SOL_SOCKET, SO_RCVBUF, &counters_.receive_buffer_bytes, &size);
  if (!set_option(socket.fd, SO_TIMESTAMPNS, 1)) return io_error("cannot have kernel receive stamps", port);

  sockaddr_in address = address_of(config.bind_address, port);
  if (::bind(socket.fd, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
    return io_error("cannot listen", port);
  socklen_t length = sizeof address;
  if (getsockname(socket.fd, reinterpret_cast<sockaddr*>(&address), &length) != 0)
    return io_error("cannot read the port back", port);
  socket.port = ntohs(address.sin_port);
  return {};
}

Result<Poll> UdpSource::next(Packet& packet, Duration timeout) {
  if (--until_count_ < 0) count_drops();
  bool waited = false;
  for (int looked = 0; looked < kMaxLooked; ++looked) {
    const auto received = receive_any(packet);
    if (!received) return received.error();
    if (*received == Received::kWanted) return Poll::kPacket;
    if (*received == Received::kUnwanted) continue;
    if (waited) break;
    until_count_ = 0;  // what comes next begins to fill an empty buffer
    if (learner_.forget_silent(clock_.now())) hear_only(std::nullopt);
    std::array fds{pollfd{sockets_[0].fd, POLLIN, 0}, pollfd{sockets_[1].fd, POLLIN, 0}};
    if (!wait_for(fds, timeout)) break;
    waited = true;
  }
  return Poll::kTimeout;
}

Result<UdpSource::Received> UdpSource::receive_any(Packet& packet) {
  turn_ ^= 1U;
  const auto first = receive(sockets_[turn_], packet);
  if (!first || *first != Received::kNothing) return first;
  return receive(sockets_[turn_ ^ 1U], packet);
}

Result<UdpSource::Received> UdpSource::receive(Socket& socket, Packet& packet) {
  packet.bytes.resize(kMaxDatagram);
  iovec part{packet.bytes.data(), packet.bytes.size()};
  sockaddr_in sender{};
  alignas(cmsghdr) std::array<std::byte, 128> control{};
  msghdr message{};
  message.msg_name = &sender;
  message.msg_namelen = sizeof sender;
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = recvmsg(socket.fd, &message, MSG_DONTWAIT);
  if (size < 0) {
    packet.bytes.clear();
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return Received::kNothing;
    return io_error("cannot receive", socket.port);
  }
  packet.bytes.resize(static_cast<std::size_t>(size));
  read_stamps(message, packet);
  const std::uint32_t from = ntohl(sender.sin_addr.s_addr);
  learn(from, packet);
  if (from != this->sender().value_or(from)) return ++counters_.foreign, Received::kUnwanted;
  if (!rate_.take(packet.arrival)) return ++counters_.flooded, Received::kUnwanted;
  packet.source = source_;
  packet.channel = socket.port;
  packet.sequence = counters_.delivered++;
  packet.truncated = (message.msg_flags & MSG_TRUNC) != 0;
  counters_.truncated += packet.truncated ? 1 : 0;
  return Received::kWanted;
}

std::optional<std::uint32_t> UdpSource::sender() const {
  return source_address_ ? source_address_ : learner_.address();
}

void UdpSource::learn(std::uint32_t sender, const Packet& packet) {
  if (source_address_) return;
  const bool valid = !learner_.address() && parse_data_packet(packet.payload(), model_).has_value();
  if (const auto learned = learner_.note(sender, valid, clock_.now())) hear_only(learned);
}

/// A kernel that refuses the filter leaves all work to receive().
void UdpSource::hear_only(std::optional<std::uint32_t> sender) {
  count_drops();
  filters_ = sender.has_value();
  for (const Socket& socket : sockets_) {
    if (!sender) admit_all(socket.fd);
    filters_ = filters_ && admit_only(socket.fd, *sender);
  }
}

/// The kernel has one count for both reasons to drop. Only a buffer that was full since it was read last is still
/// almost full now.
void UdpSource::count_drops() {
  constexpr std::uint32_t kFull = 4, kAlmostFull = 3;
  until_count_ = kMaxLooked;
  for (Socket& socket : sockets_) {
    const auto memory = socket_memory(socket.fd);
    if (!memory) continue;
    const std::uint32_t drops = memory->drops - std::exchange(socket.drops, memory->drops);
    const bool full = memory->waiting_bytes / kAlmostFull >= memory->buffer_bytes / kFull;
    (filters_ && !full ? counters_.filtered : counters_.kernel_drops) += drops;
  }
}

/// Takes the kernel's receive stamp from the message. It is on CLOCK_REALTIME; one that would lie in the future or more
/// than a second back on the monotonic line was made before the wall clock was set.
void UdpSource::read_stamps(msghdr& message, Packet& packet) {
  const Time now = clock_.now();
  packet.arrival = Time::min();
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec stamp;
    std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
    const Duration realtime = std::chrono::seconds(stamp.tv_sec) + std::chrono::nanoseconds(stamp.tv_nsec);
    packet.arrival = Time{realtime - LiveClock::realtime_offset()};
  }
  constexpr Duration kFuture = std::chrono::milliseconds(1), kPast = std::chrono::seconds(1);
  if (packet.arrival > now + kFuture || packet.arrival < now - kPast) {
    packet.arrival = now;
    ++counters_.unstamped;
  }
}

}  // namespace cairn::velodyne
