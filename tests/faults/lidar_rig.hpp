// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "drivers/recording/faulty_source.hpp"
#include "drivers/velodyne/lidar.hpp"
#include "tests/faults/task_rig.hpp"
#include "tests/support/velodyne_encoder.hpp"

namespace cairn::faults {

/// A device whose packets go through the injector. Those of the fault's time, and no others, are SourceId{1}: what the
/// injector is told to strike.
class SickSource final : public Source {
 public:
  static constexpr SourceId kStruck{1};
  using Next = std::function<void(Packet&)>;

  /// `next` makes the packets, forever; those that arrive in [from, to) are struck.
  SickSource(Next next, Time from, Time to, const recording::Faults& faults)
      : device_(std::move(next), from, to), injector_(device_, struck(faults)) {}
  Result<Poll> next(Packet& packet, Duration timeout) override { return injector_.next(packet, timeout); }

 private:
  static recording::Faults struck(recording::Faults faults) {
    faults.only = kStruck;
    return faults;
  }
  class Device final : public Source {
   public:
    Device(Next next, Time from, Time to) : next_(std::move(next)), from_(from), to_(to) {}
    Result<Poll> next(Packet& packet, Duration /*timeout*/) override {
      next_(packet);
      packet.source = packet.arrival >= from_ && packet.arrival < to_ ? kStruck : SourceId{0};
      return Poll::kPacket;
    }

   private:
    Next next_;
    Time from_, to_;
  };
  Device device_;
  recording::FaultySource injector_;
};

/// A VLP-16 at 10 Hz → injector → the real decoder → the robot's tasks. The fault lasts from TaskRig::kBegin to `lasts`
/// later; before and after nothing is wrong.
class LidarRig {
 public:
  LidarRig(const recording::Faults& faults, Duration lasts) : rig_(lasts) {
    auto lidar = velodyne::Lidar::create({}, SourceId{0}, rig_.monitor()).value();
    lidar_ = lidar.get();
    sensor_.device_ns = Duration(std::chrono::minutes(20)).count();
    start_ = sensor_.start + Duration{sensor_.device_ns};
    // A spell is struck a little longer at both ends: the packet before it is what a stuck device repeats, and with the
    // one after it comes what a burst held back.
    const Duration margin = faults.freeze > Duration{} ? std::chrono::milliseconds(3) : Duration{};
    const Time begin = start_ + TaskRig::kBegin;
    rig_.add(
        recording::kVelodyne,
        std::make_unique<SickSource>([this](Packet& p) { send(p); }, begin - margin, begin + lasts + margin, faults),
        std::move(lidar));
  }

  /// Something done to the sensor itself when the fault begins.
  std::function<void(velodyne::test::Sensor&)> strike;

  Measured run(std::optional<safety::Fault> fault = {}) { return rig_.run(start_, fault); }

  [[nodiscard]] const std::vector<Scan>& scans() const { return rig_.scans(); }
  [[nodiscard]] const velodyne::Counters& counters() const { return lidar_->counters(); }
  [[nodiscard]] Time start() const { return start_; }
  [[nodiscard]] TaskRig& tasks() { return rig_; }

 private:
  void send(Packet& packet) {
    const Time now = sensor_.start + Duration{sensor_.device_ns};
    if (strike && now - start_ >= TaskRig::kBegin) std::exchange(strike, {})(sensor_);
    sensor_.next(packet);
  }

  velodyne::test::Sensor sensor_;
  TaskRig rig_;
  velodyne::Lidar* lidar_;
  Time start_;
};

}  // namespace cairn::faults
