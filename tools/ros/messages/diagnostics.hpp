// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/clients/messages/event.hpp"
#include "drivers/clients/messages/pose.hpp"
#include "drivers/clients/messages/state.hpp"
#include "tools/ros/messages/header.hpp"

namespace cairn::ros {

/// As diagnostic_msgs/DiagnosticStatus numbers it.
enum class DiagnosticLevel : std::uint8_t { kOk = 0, kWarn = 1, kError = 2, kStale = 3 };

/// One status, before it is a message.
struct Diagnosis {
  DiagnosticLevel level = DiagnosticLevel::kOk;
  std::string name, message;
  std::vector<std::pair<std::string, std::string>> values{};
};

/// What a running core has said of itself, for people who look at ROS's diagnostics.
class Health {
 public:
  void take(const clients::PoseMessage& pose) { pose_ = pose; }
  void take(const clients::StateMessage& state) { state_ = state; }
  /// At most kMostEvents kinds are kept.
  void take(const clients::EventMessage& event);
  /// The core has ended: all that it said is stale. The next greeting ends that.
  void core_gone() { there_ = false; }
  void core_came();
  /// Anything came from the core. If nothing does for kSilence, it hangs: that is stale as well.
  void heard(Time now) { heard_ = now; }
  static constexpr Duration kSilence = std::chrono::seconds(3);

  /// As the core said last; none: it has not.
  [[nodiscard]] std::optional<std::uint32_t> arming_epoch() const {
    return there_ && state_ ? std::optional(state_->arming_epoch) : std::nullopt;
  }
  /// Core, mode, odometry, and each stage that had events: always in this order.
  [[nodiscard]] std::vector<Diagnosis> diagnoses(Time now) const;

 private:
  static constexpr std::size_t kMostEvents = 256;

  [[nodiscard]] Diagnosis core(bool answers) const;
  [[nodiscard]] Diagnosis mode() const;
  [[nodiscard]] Diagnosis odometry() const;
  void append_stages(std::vector<Diagnosis>& all) const;

  bool there_ = false;
  Time heard_{};
  std::optional<clients::PoseMessage> pose_;
  std::optional<clients::StateMessage> state_;
  struct Event {
    std::uint64_t count = 0;
    Time stamp{};
  };
  std::map<std::string, std::map<std::string, Event>> stages_;
  std::size_t events_ = 0;
};

/// Names get `robot` in front: "husky: mode"; it is the hardware's id as well.
[[nodiscard]] DiagnosticArray diagnostics_of(const std::vector<Diagnosis>& diagnoses, const std::string& robot,
                                             Time now, Duration utc_offset, Arena& arena);

}  // namespace cairn::ros
