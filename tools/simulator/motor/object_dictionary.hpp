// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "drivers/drive/canopen/canopen.hpp"
#include "drivers/drive/canopen/cia402.hpp"

namespace cairn::simulator {

/// The object dictionary of a CiA 402 motor controller, and the access rules of its SDO server (CiA 301).
class ObjectDictionary {
 public:
  using Object = drive::canopen::Object;

  /// Of a node without power: empty.
  ObjectDictionary() = default;
  /// As after power-up. `ramp`: acceleration and deceleration in drive units per second; a quick stop has three times
  /// as much. No PDO is mapped.
  ObjectDictionary(std::uint32_t vendor, std::uint32_t product, std::uint32_t ramp);

  /// 0 for an object that does not exist.
  [[nodiscard]] std::uint32_t value(Object object) const;
  [[nodiscard]] bool has(Object object) const { return entries_.contains(key(object)); }
  /// The device's own write: no rule of access applies. The object must exist.
  void put(Object object, std::uint32_t value) { entries_.at(key(object)).value = value; }

  /// What the SDO server answers; a write that it grants changes the value. Refused with an abort code: objects that
  /// do not exist, writes of read-only objects or of another length, and mappings while the node is operational.
  /// `request` is a read or a write.
  [[nodiscard]] drive::canopen::SdoResponse answer(const drive::canopen::SdoRequest& request, bool operational);

 private:
  struct Entry {
    std::uint32_t value = 0;
    std::uint8_t bytes = 4;
    bool writable = true;
  };
  using Key = std::uint32_t;
  static constexpr Key key(Object o) { return static_cast<Key>(o.index) << 8U | o.sub; }
  void define(Object object, std::uint32_t value, std::uint8_t bytes, bool writable) {
    entries_[key(object)] = {value, bytes, writable};
  }
  void define_pdos();
  /// 0: granted and done; otherwise the abort code.
  std::uint32_t write(const drive::canopen::SdoRequest& request, bool operational);

  std::map<Key, Entry> entries_;
};

}  // namespace cairn::simulator
