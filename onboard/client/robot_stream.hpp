// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "drivers/clients/messages/camera.hpp"
#include "drivers/clients/messages/event.hpp"
#include "drivers/clients/messages/hello.hpp"
#include "drivers/clients/messages/people.hpp"
#include "drivers/clients/messages/pose.hpp"
#include "drivers/clients/messages/state.hpp"
#include "drivers/clients/messages/subscribe.hpp"
#include "drivers/clients/messages/tiles.hpp"
#include "drivers/clients/messages/wheels.hpp"
#include "drivers/clients/sockets/local_client.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"
#include "onboard/client/picture_assembly.hpp"
#include "onboard/client/scan_assembly.hpp"

/// What another program on the robot reads of a running core, and how.
namespace cairn::client {

using clients::CameraMessage;
using clients::EventMessage;
using clients::HelloMessage;
using clients::PeopleMessage;
using clients::PoseMessage;
using clients::StateMessage;
using clients::SubscribeMessage;
using clients::TilesMessage;
using clients::WheelsMessage;

inline constexpr const char* kRobotSocket = "/run/cairn/robot.sock";

/// The core has gone. The next call of next() looks for it again.
struct CoreGone {};

/// What next() found; std::monostate: nothing came in time.
using StreamMessage =
    std::variant<std::monostate, HelloMessage, PoseMessage, StateMessage, TilesMessage, ScanMessage, ThermalMessage,
                 EventMessage, PeopleMessage, CameraMessage, PictureMessage, WheelsMessage, CoreGone>;

/// A subscription to robot.sock. It survives the end of a core, and finds the next one. One thread uses it.
class RobotStream {
 public:
  /// `wants`: see SubscribeMessage. Errors: those of clients::LocalClient::connect(); kNotFound: no core is there.
  [[nodiscard]] static Result<RobotStream> connect(const std::filesystem::path& socket, const SubscribeMessage& wants);

  /// The next message; waits at most `timeout`. After a core has come back, its greeting is the first. Errors:
  /// kMalformed and kUnsupported, for a record that is none of this release's; going on is possible.
  [[nodiscard]] Result<StreamMessage> next(Duration timeout);

  /// From now on: other streams, or the tiles that a map lacks after this one. False: the core takes nothing now.
  bool subscribe(const SubscribeMessage& wants);
  /// What is asked for again when a core has come back. To be kept up to date by who mirrors a map.
  [[nodiscard]] SubscribeMessage& wants() { return wants_; }

  /// Records that this client was too slow for, in all connections. Tiles are never among them.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  [[nodiscard]] bool connected() const { return link_.has_value(); }
  /// Readable when a message has come: for poll(). -1: no core is there.
  [[nodiscard]] int readable_fd() const { return link_ ? link_->readable_fd() : -1; }

 private:
  RobotStream(std::filesystem::path socket, const SubscribeMessage& wants)
      : socket_(std::move(socket)), wants_(wants) {}
  Result<void> join();
  void wait_for_core(Duration timeout);
  Result<StreamMessage> decode();

  std::filesystem::path socket_;
  SubscribeMessage wants_;
  std::optional<clients::LocalClient> link_;
  std::optional<std::uint32_t> sequence_;  // of the last record
  std::uint64_t lost_ = 0;
  ScanAssembly scans_;
  ThermalAssembly thermals_;
  PictureAssembly pictures_;
  std::vector<std::byte> bytes_;  // reused
};

}  // namespace cairn::client
