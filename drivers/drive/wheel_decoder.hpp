// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "drivers/drive/chassis/config.hpp"
#include "drivers/drive/wheel_odometry.hpp"
#include "hal/drive.hpp"

namespace cairn::drive {

struct CanFrame;

/// What one wheel did.
struct WheelMotion {
  bool left = false, rear = false;  ///< rear: behind another one of its side
  double travel_m = 0;              ///< of its rim since the first reading, forward
  double speed_m_s = 0;             ///< of its rim, over the last interval between readings
};
/// All wheels, as of the last complete set of readings.
struct WheelMotions {
  static constexpr std::size_t kMost = 4;
  std::array<WheelMotion, kMost> wheels{};
  std::size_t count = 0;
  [[nodiscard]] std::span<const WheelMotion> all() const { return std::span(wheels).first(count); }
};

/// Frames of a drive → wheel odometry: TPDO2 of every node as this master maps it, or the odometer of AgileX. It works
/// for a live bus, a recording or a simulation. Frames without wheel readings are skipped.
class WheelDecoder final : public DriveDecoder {
 public:
  /// What happened to the frames.
  struct Counters {
    std::uint64_t frames = 0, readings = 0;
    std::uint64_t rejected = 0;  ///< malformed packets or messages
    std::uint64_t alone = 0;     ///< readings of one wheel while those of the others were lost
  };
  /// Readings of the wheels that belong together come within half a SYNC period.
  static constexpr Duration kTogether = std::chrono::milliseconds(5);

  /// Error kInvalidConfig: the scales that turn counts into metres are not configured.
  static Result<std::unique_ptr<WheelDecoder>> create(const Config& config);

  Result<const DriveState*> decode(const Packet& packet) override;
  /// The same for a frame that is decoded already.
  Result<const DriveState*> decode(const CanFrame& frame, Time arrival);
  [[nodiscard]] const Counters& counters() const { return counters_; }
  /// Every wheel by itself.
  [[nodiscard]] const WheelMotions& motions() const { return motions_; }

 private:
  struct Wheel {
    std::uint8_t node = 0;
    bool left = false;
    double metres_per_count = 0;  // negative: reversed
    WheelCounter counter;
    std::int32_t count = 0;
    std::optional<Time> fresh;  // a reading that is not used yet
  };
  explicit WheelDecoder(const Config& config);
  Result<const DriveState*> decode_canopen(const CanFrame& frame, Time arrival);
  Result<const DriveState*> decode_agilex(const CanFrame& frame, Time arrival);
  void take(Wheel& wheel, std::int32_t count, Time arrival);
  const DriveState* combine(Time arrival);
  std::optional<Travel> take_travel(Time arrival);

  Config config_;
  bool agilex_;
  std::vector<Wheel> wheels_;
  WheelOdometry odometry_;
  bool started_ = false;
  WheelMotions motions_;
  std::optional<Time> last_;  // arrival of the last complete set
  Counters counters_;
};

}  // namespace cairn::drive
