// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/can_hub.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "drivers/clients/sockets/local_address.hpp"
#include "drivers/drive/can/bus_name.hpp"

namespace cairn::simulator {

using drive::SendResult;
using drive::UnixCanLink;

namespace {

constexpr const char* kRemedy = "choose another path: --can unix:PATH";

Error bus_error(std::string_view cause, const std::string& path) {
  Error error = clients::local_error(cause, path);
  error.detail.append("; ").append(kRemedy);
  return error;
}

/// Removes the name that a killed program has left.
Result<void> clear(const sockaddr_un& address, const std::string& path) {
  if (const int other = clients::connect_local(address); other >= 0) {
    ::close(other);
    return Error{Errc::kIo, "another program plays this bus", path, {}, kRemedy};
  }
  struct stat there {};
  if (::lstat(path.c_str(), &there) == 0 && S_ISSOCK(there.st_mode)) ::unlink(path.c_str());
  return {};
}

}  // namespace

Result<std::unique_ptr<CanHub>> CanHub::open(const std::string& interface, const Clock& clock) {
  const auto path = drive::path_of_unix_bus(interface);
  if (!path) return path.error();
  const auto address = clients::local_address(*path);
  if (!address) return Error{Errc::kInvalidConfig, "no path for a local socket", *path, {}, clients::kPathRule};
  if (auto cleared = clear(*address, *path); !cleared) return cleared.error();
  const int fd = ::socket(AF_UNIX, clients::kLocalType, 0);
  if (fd < 0) return bus_error("cannot make a socket", *path);
  std::unique_ptr<CanHub> hub(new CanHub(fd, {}, clock));
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0)
    return bus_error("cannot bind the socket", *path);
  hub->path_ = *path;
  constexpr ::mode_t kOwnerAndGroup = 0660;
  if (::chmod(path->c_str(), kOwnerAndGroup) != 0 || ::listen(fd, static_cast<int>(kMaxClients)) != 0)
    return bus_error("cannot listen on the socket", *path);
  return hub;
}

CanHub::~CanHub() {
  ::close(fd_);
  if (!path_.empty()) ::unlink(path_.c_str());
}

Result<void> CanHub::accept_clients() {
  for (std::size_t i = 0; i < kMaxClients; ++i) {
    const int fd = ::accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (fd < 0) break;
    auto client = UnixCanLink::adopt(fd, SourceId{0}, clock_);
    if (clients_.size() == kMaxClients)
      return Error{Errc::kLimit, "one more program wanted to join this bus", path_.string(), {}, "8 can be connected"};
    clients_.push_back(std::move(client));
  }
  return {};
}

Result<Poll> CanHub::next(Packet& packet, Duration /*timeout*/) {
  drop_lost();
  if (auto accepted = accept_clients(); !accepted) return accepted.error();
  for (std::size_t tried = 0; tried < clients_.size(); ++tried) {
    turn_ = (turn_ + 1) % clients_.size();
    const auto taken = take_from(clients_[turn_], packet);
    if (!taken) return taken.error();
    if (*taken) return Poll::kPacket;
  }
  return Poll::kTimeout;
}

Result<bool> CanHub::take_from(Client& client, Packet& packet) {
  do {
    const auto poll = client->next(packet, Duration::zero());
    if (!poll || *poll != Poll::kPacket) return false;  // a program that has gone is dropped later
  } while (packet.channel == static_cast<std::uint16_t>(drive::Direction::kSent));
  const auto frame = drive::decode_frame(packet.payload());
  if (packet.truncated || !frame)
    return Error{Errc::kMalformed, "a program sent what is no CAN frame", path_.string(), {}, {}};
  (void)pass_on(*frame, &client);  // who has no room loses the frame
  return true;
}

SendResult CanHub::pass_on(const drive::CanFrame& frame, const Client* from) {
  SendResult result = SendResult::kSent;
  for (Client& client : clients_)
    if (&client != from && client->send(frame) == SendResult::kQueueFull) result = SendResult::kQueueFull;
  return result;
}

void CanHub::drop_lost() {
  std::erase_if(clients_, [](const Client& client) { return !client->is_open(); });
}

SendResult CanHub::send(const drive::CanFrame& frame) { return pass_on(frame, nullptr); }

}  // namespace cairn::simulator
