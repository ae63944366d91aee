// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motor/pdo_mapping.hpp"

#include <algorithm>

namespace cairn::simulator {

using namespace drive;
using canopen::Object;

namespace {

constexpr std::uint32_t kMostEntries = 64;                // of one PDO (CiA 301, 7.4.4)
constexpr std::size_t kFrameBytes = 8, kObjectBytes = 4;  // no object of the dictionary has more

/// One PDO, as the dictionary describes it.
class Pdo {
 public:
  /// `base`: 0x1400 for those received, 0x1800 for those sent.
  Pdo(const ObjectDictionary& objects, unsigned base, unsigned n)
      : objects_(objects),
        mapping_(static_cast<std::uint16_t>(base + 0x200U + n)),
        id_(objects.value({static_cast<std::uint16_t>(base + n), 1})) {}

  [[nodiscard]] bool valid() const { return (id_ & 0x80000000U) == 0; }
  [[nodiscard]] std::uint32_t id() const { return id_ & 0x7FFU; }
  [[nodiscard]] std::uint8_t entries() const {
    return static_cast<std::uint8_t>(std::min(objects_.value({mapping_, 0}), kMostEntries));
  }
  /// `sub` counts from 1.
  [[nodiscard]] Object object(std::uint8_t sub) const {
    const std::uint32_t entry = objects_.value({mapping_, sub});
    return {static_cast<std::uint16_t>(entry >> 16U), static_cast<std::uint8_t>(entry >> 8U & 0xFFU)};
  }
  [[nodiscard]] std::size_t bytes(std::uint8_t sub) const { return (objects_.value({mapping_, sub}) & 0xFFU) / 8; }

 private:
  const ObjectDictionary& objects_;
  std::uint16_t mapping_;
  std::uint32_t id_;
};

std::uint32_t load(const CanFrame& frame, std::size_t at, std::size_t bytes) {
  if (bytes == 4) return canopen::load_u32(frame, at);
  if (bytes == 2) return canopen::load_u16(frame, at);
  return at < frame.data.size() ? frame.data[at] : 0U;
}

}  // namespace

void unpack_rpdos(const CanFrame& frame, ObjectDictionary& objects, const std::function<void(Object)>& written) {
  for (unsigned n = 0; n < 2; ++n) {
    const Pdo pdo(objects, 0x1400, n);
    if (!pdo.valid() || !frame.is(pdo.id())) continue;
    std::size_t at = 0;
    for (std::uint8_t sub = 1; sub <= pdo.entries(); ++sub) {
      const Object target = pdo.object(sub);
      const std::size_t bytes = pdo.bytes(sub);
      if (at + bytes > frame.length || !objects.has(target)) return;
      objects.put(target, load(frame, at, bytes));
      at += bytes;
      written(target);
    }
  }
}

void pack_tpdos(const ObjectDictionary& objects, std::vector<CanFrame>& out) {
  for (unsigned n = 0; n < 2; ++n) {
    const Pdo pdo(objects, 0x1800, n);
    if (!pdo.valid()) continue;
    CanFrame frame;
    frame.id = pdo.id();
    for (std::uint8_t sub = 1; sub <= pdo.entries(); ++sub) {
      const std::size_t bytes = pdo.bytes(sub);
      if (bytes > kObjectBytes || frame.length + bytes > kFrameBytes) return;
      canopen::store(frame, frame.length, objects.value(pdo.object(sub)), bytes);
      frame.length = static_cast<std::uint8_t>(frame.length + bytes);
    }
    out.push_back(frame);
  }
}

}  // namespace cairn::simulator
