// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "drivers/drive/can/can_frame.hpp"
#include "tools/simulator/motor/object_dictionary.hpp"

/// Process data of a CANopen node: two frames each way, which carry what the dictionary's mapping says (CiA 301).
namespace cairn::simulator {

/// Writes what a frame carries for this node into the dictionary, and calls `written` after each object. Stops at an
/// object that does not exist, and where the frame is shorter than its mapping.
void unpack_rpdos(const drive::CanFrame& frame, ObjectDictionary& objects,
                  const std::function<void(drive::canopen::Object)>& written);

/// Appends the frames that the node sends on SYNC. Stops at a mapping of more than eight bytes, and at an entry that is
/// longer than any object.
void pack_tpdos(const ObjectDictionary& objects, std::vector<drive::CanFrame>& out);

}  // namespace cairn::simulator
