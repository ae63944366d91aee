// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motor/object_dictionary.hpp"

namespace cairn::simulator {

using namespace drive;
using canopen::SdoRequest;
using canopen::SdoResponse;

namespace {

constexpr std::uint32_t kAbortLength = 0x06070010;  // data type does not match (CiA 301, table 22)
constexpr std::uint32_t kUnmapped = 0x80000000U;    // the bit of a PDO's identifier that switches it off

}  // namespace

ObjectDictionary::ObjectDictionary(std::uint32_t vendor, std::uint32_t product, std::uint32_t ramp) {
  define(cia402::kDeviceType, 0x00020192, 4, false);
  define(cia402::kVendor, vendor, 4, false);
  define(cia402::kProduct, product, 4, false);
  define(cia402::kConsumerHeartbeat, 0, 4, true);
  define(cia402::kProducerHeartbeat, 0, 2, true);
  define(cia402::kAbortConnection, 1, 2, true);
  define(cia402::kErrorCode, 0, 2, false);
  define(cia402::kControlword, 0, 2, true);
  define(cia402::kStatusword, 0, 2, false);
  define(cia402::kQuickStopOption, 2, 2, true);
  define(cia402::kMode, 0, 1, true);
  define(cia402::kModeDisplay, 0, 1, false);
  define(cia402::kPosition, 0, 4, false);
  define(cia402::kVelocity, 0, 4, false);
  define(cia402::kAcceleration, ramp, 4, true);
  define(cia402::kDeceleration, ramp, 4, true);
  define(cia402::kQuickStopDeceleration, 3 * ramp, 4, true);
  define(cia402::kTargetVelocity, 0, 4, true);
  define_pdos();
}

void ObjectDictionary::define_pdos() {
  for (std::uint16_t n = 0; n < 2; ++n) {
    for (const unsigned base : {0x1400U, 0x1800U}) {
      const auto communication = static_cast<std::uint16_t>(base + n),
                 mapping = static_cast<std::uint16_t>(base + 0x200U + n);
      define({communication, 1}, kUnmapped, 4, true);
      define({communication, 2}, 255, 1, true);
      define({mapping, 0}, 0, 1, true);
      for (std::uint8_t sub = 1; sub <= 8; ++sub) define({mapping, sub}, 0, 4, true);
    }
  }
}

std::uint32_t ObjectDictionary::value(Object object) const {
  const auto found = entries_.find(key(object));
  return found == entries_.end() ? 0 : found->second.value;
}

SdoResponse ObjectDictionary::answer(const SdoRequest& request, bool operational) {
  using Kind = SdoResponse::Kind;
  const auto found = entries_.find(key(request.object));
  if (found == entries_.end()) return {Kind::kAbort, request.object, canopen::kAbortNoObject, 0};
  if (request.kind == SdoRequest::Kind::kRead)
    return {Kind::kValue, request.object, found->second.value, found->second.bytes};
  const std::uint32_t abort = write(request, operational);
  return {abort == 0 ? Kind::kWritten : Kind::kAbort, request.object, abort, 0};
}

std::uint32_t ObjectDictionary::write(const SdoRequest& request, bool operational) {
  Entry& entry = entries_.at(key(request.object));
  if (!entry.writable) return canopen::kAbortReadOnly;
  if (entry.bytes != request.bytes) return kAbortLength;
  const unsigned group = request.object.index & 0xFF00U;
  const bool mapping = group == 0x1600 || group == 0x1A00;
  if (mapping && operational) return canopen::kAbortState;
  entry.value = request.value;
  return 0;
}

}  // namespace cairn::simulator
