// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "onboard/client/map_mirror.hpp"
#include "onboard/client/robot_stream.hpp"
#include "onboard/client/view/costmap.hpp"
#include "tools/python/arrays.hpp"
#include "tools/python/map.hpp"
#include "tools/python/map_changed.hpp"
#include "tools/python/recorded_pictures.hpp"

namespace cairn::python {

/// How often a stream may come, in Hz; 0: as in client::SubscribeMessage.
struct Rates {
  double pose_hz = 0, scan_hz = 0, picture_hz = 0;
};

/// A running core as Python reads it: its messages, and what they have told so far.
class Robot {
 public:
  /// `streams`: names of what is wanted. Throws ValueError for another name, Failure if no core is there.
  Robot(const std::filesystem::path& socket, const std::vector<std::string>& streams, const Rates& rates);

  /// The next message, or None after `timeout_s`; Ctrl-C interrupts it. Throws Failure for a record that is none of
  /// this release's; going on is possible.
  [[nodiscard]] py::object next(double timeout_s);
  /// The next message, however long it takes; throws StopIteration when the core ends.
  [[nodiscard]] py::object next_or_end();

  [[nodiscard]] std::uint64_t lost() const { return stream_.lost(); }
  /// A copy of what has come of a map; Failure: it was not asked for, or the core has not spoken yet.
  [[nodiscard]] Map own_map() const { return copy_of(own_, "own_map"); }
  [[nodiscard]] Map team_map() const { return copy_of(team_, "team_map"); }
  /// Around the last pose; Failure: the streams pose and own_map are needed.
  [[nodiscard]] client::Costmap costmap(const client::CostmapConfig& config) const;

 private:
  using Mirror = std::optional<client::MapMirror>;

  [[nodiscard]] py::object take(client::StreamMessage message);
  void take(const client::HelloMessage& hello);
  [[nodiscard]] MapChanged take(const client::TilesMessage& tiles);
  [[nodiscard]] PyPicture picture_of(const client::PictureMessage& picture) const;
  void mirror(Mirror& mirror, const client::TilesMessage& tiles, client::SubscribeMessage::Resume& has);
  [[nodiscard]] static Map copy_of(const Mirror& mirror, const char* stream);

  client::RobotStream stream_;
  Mirror own_, team_;
  std::optional<SE3> T_odom_base_, T_team_odom_;
  std::map<std::uint8_t, client::CameraMessage> cameras_;  // by number
};

}  // namespace cairn::python
