// SPDX-License-Identifier: Apache-2.0
// Any frames at any time: a drive of either protocol keeps a finite state with a sound covariance, and it sends no
// order to move unless all is well.
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "drivers/drive/agilex/agilex.hpp"
#include "drivers/drive/can_drive.hpp"
#include "drivers/drive/canopen/cia402.hpp"

namespace {

using namespace cairn;
using namespace cairn::drive;

/// A bus that gives one packet and looks at what is sent.
class FuzzLink final : public CanLink {
 public:
  Result<Poll> next(Packet& packet, Duration) override {
    if (!full) return Poll::kTimeout;
    packet = given;
    full = false;
    return Poll::kPacket;
  }
  SendResult send(const CanFrame& frame) override {
    if (result == SendResult::kSent && drive->status().level != DriveLevel::kNormal && moves(frame)) std::abort();
    return result;
  }
  Result<void> restart() override { return {}; }

  Packet given;
  bool full = false;
  SendResult result = SendResult::kSent;
  const CanDrive* drive = nullptr;

 private:
  static bool moves(const CanFrame& frame) {
    if (frame.id >= 0x201 && frame.id <= 0x27F) return cia402::decode_rpdo1(frame).value().target_velocity != 0;
    if (frame.id != agilex::kMotionCommandId) return false;
    const auto motion = agilex::read_motion(frame);
    return motion.v != 0 || motion.w != 0 || motion.steering != 0;
  }
};

void check(const DriveState& state) {
  const bool finite = std::isfinite(state.v) && std::isfinite(state.w) && state.T_odom_base.covariance.allFinite() &&
                      state.T_odom_base.mean.translation().allFinite() && state.twist_covariance.allFinite();
  if (!finite || state.T_odom_base.covariance.diagonal().minCoeff() < 0) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return 0;
  Config config;
  config.protocol = data[0] % 2 == 0 ? "cia402" : "agilex";
  config.wheel_radius_m = 0.16;
  config.wheel_separation_m = 0.5;
  config.velocity_units_per_rad_s = 1000;
  config.position_counts_per_rad = 10000;
  FuzzLink link;
  auto drive = CanDrive::create(config, link).value();
  link.drive = drive.get();
  Time now{std::chrono::seconds(1)};
  std::uint32_t epoch = 0;
  // Records: what to do, milliseconds to wait, struct can_frame.
  constexpr std::size_t kRecord = 2 + kClassicBytes;
  for (std::size_t at = 1; at + kRecord <= size; at += kRecord) {
    now += std::chrono::milliseconds(data[at + 1]);
    link.given.arrival = now;
    link.given.bytes.resize(kClassicBytes);
    std::memcpy(link.given.bytes.data(), data + at + 2, kClassicBytes);
    const unsigned act = data[at];
    link.full = (act & 1U) != 0;
    link.result = (act & 2U) != 0 ? static_cast<SendResult>(data[at + 1] % 3) : SendResult::kSent;
    if ((act & 4U) != 0)
      if (const auto armed = drive->arm(now)) epoch = *armed;
    if ((act & 8U) != 0) (void)drive->command({0.5, data[at + 1] * 0.01, epoch}, now);
    if ((act & 48U) == 48U) drive->stop(DriveCause::kRequested, now);
    const auto state = drive->tick(now);
    if (state && *state != nullptr) check(**state);
  }
  return 0;
}
