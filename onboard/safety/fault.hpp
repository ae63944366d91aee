// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace cairn::safety {

/// What the robot may do. The worst active fault decides.
enum class Mode : std::uint8_t {
  kNormal,    ///< commands are executed
  kDegraded,  ///< commands are executed, below a speed cap
  kHold,      ///< zero is commanded, the drive stays enabled; ends with its cause
  kStop,      ///< zero is commanded and the drive is disabled; only re-arming ends it
};
[[nodiscard]] std::string_view to_string(Mode mode);

/// Everything that can be wrong with one robot. Logs, reports and scripts rely on the codes: numbers and names never
/// change their meaning.
enum class Fault : std::uint8_t {
  kLidarLate = 0,
  kLidarSilent = 1,
  kLidarRejected = 2,
  kLidarStuck = 3,
  kCameraSilent = 4,
  kThermalSilent = 5,
  kDepthSilent = 6,
  kOdometryLost = 7,
  kFeedbackLate = 8,
  kFeedbackLost = 9,
  kBusFailing = 10,
  kLinkDown = 11,
  kMotorFault = 12,
  kMotorReset = 13,
  kSendQueueFull = 14,
  kDriveNotReady = 15,
  kEStopOpen = 16,
  kEStopLost = 17,
  kSafetyMissed = 18,
  kStageDemoted = 19,
  kOverload = 20,
  kBestEffort = 21,
  kMemoryShort = 22,
  kDiskFailing = 23,
  kStateLost = 24,
  kTaskHung = 25,
  kCrashLoop = 26,
};
inline constexpr std::size_t kFaults = 27;

/// One row of the fault table: what holds for a fault on every robot.
struct FaultRow {
  Fault fault{};
  std::string_view code;  ///< stable; also its key in the profile's section `failsafe`
  Mode least{};           ///< the mildest safe mode; a profile may ask for a stricter one
  Mode usual{};           ///< when the profile says nothing
  std::string_view doc;
};
/// In the order of their numbers.
[[nodiscard]] const std::array<FaultRow, kFaults>& fault_table();
[[nodiscard]] std::string_view to_string(Fault fault);

/// A set of faults.
class FaultSet {
 public:
  constexpr FaultSet() = default;
  constexpr explicit FaultSet(std::uint32_t bits) : bits_(bits) {}
  constexpr FaultSet(std::initializer_list<Fault> faults) {
    for (const Fault f : faults) set(f);
  }

  constexpr void set(Fault f, bool on = true) {
    const std::uint32_t bit = 1U << static_cast<unsigned>(f);
    bits_ = on ? bits_ | bit : bits_ & ~bit;
  }
  [[nodiscard]] constexpr bool has(Fault f) const { return (bits_ >> static_cast<unsigned>(f) & 1U) != 0; }
  [[nodiscard]] constexpr bool empty() const { return bits_ == 0; }
  [[nodiscard]] constexpr std::uint32_t bits() const { return bits_; }
  friend constexpr FaultSet operator|(FaultSet a, FaultSet b) { return FaultSet(a.bits_ | b.bits_); }
  friend constexpr FaultSet operator&(FaultSet a, FaultSet b) { return FaultSet(a.bits_ & b.bits_); }
  friend constexpr FaultSet operator-(FaultSet a, FaultSet b) { return FaultSet(a.bits_ & ~b.bits_); }
  friend constexpr bool operator==(FaultSet, FaultSet) = default;

 private:
  std::uint32_t bits_ = 0;
};
static_assert(kFaults <= 32);

}  // namespace cairn::safety
