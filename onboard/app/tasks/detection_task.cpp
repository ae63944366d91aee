// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/detection_task.hpp"

#include <algorithm>
#include <utility>

namespace cairn::app {

using scheduler::Regime;
using scheduler::Tick;

DetectionTask::DetectionTask(DetectionParts parts, const std::string& stage, Duration budget,
                             std::function<safety::Shed()> shed, Monitor& monitor)
    : parts_(std::move(parts)),
      pace_(parts_.period),
      shed_(std::move(shed)),
      monitor_(monitor),
      stage_(monitor.stage(stage, budget)) {}

void DetectionTask::tick(Tick& tick) {
  const Packet* newest = pace_.take_newest(pictures, tick, figures_.passed);
  if (newest == nullptr || tick.regime() == Regime::kDrain) return;
  const auto overloaded = [this] { return shed_() >= safety::Shed::kSemantics ? 1 : 0; };
  if (tick.decide(shed_slot, overloaded, 0) != 0)
    ++figures_.shed;
  else
    look(*newest, tick);
}

void DetectionTask::look(const Packet& packet, Tick& tick) {
  const auto found = detect(packet);
  if (!found) return refuse(found.error(), packet.arrival);
  if (*found == nullptr) {
    ++figures_.correcting;
    return;
  }
  ++figures_.images;
  figures_.people +=
      static_cast<std::uint64_t>(std::ranges::count((*found)->found, std::uint8_t{kPersonClass}, &Detection::class_id));
  if (tap_) tap_(**found);
  hand_on(**found, tick);
}

Result<const Detections*> DetectionTask::detect(const Packet& packet) {
  const StageTimer timing(stage_);
  const auto seen = parts_.reader->read(packet);
  if (!seen) return seen.error();
  if (*seen == nullptr) return static_cast<const Detections*>(nullptr);
  return parts_.detector->detect(**seen);
}

void DetectionTask::hand_on(const Detections& found, Tick& tick) {
  ArrivedBoxes* out = boxes.back(tick);
  if (out == nullptr) return monitor_.event(found.stamp, "detection", "boxes were dropped: mapping is behind");
  out->eye = parts_.eye;
  out->boxes = found;
  boxes.push(tick);
}

void DetectionTask::refuse(const Error& error, Time when) {
  if (error.code == Errc::kNotFound) {
    ++figures_.unknown;
    return;
  }
  ++figures_.refused;
  monitor_.event(when, "detection", to_string(error));
}

}  // namespace cairn::app
