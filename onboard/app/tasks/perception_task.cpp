// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/perception_task.hpp"

#include <utility>

namespace cairn::app {

using scheduler::Regime;
using scheduler::Tick;

PerceptionTask::PerceptionTask(PerceptionParts parts, Duration budget, std::function<safety::Shed()> shed,
                               Monitor& monitor)
    : parts_(std::move(parts)),
      pace_(parts_.period),
      shed_(std::move(shed)),
      monitor_(monitor),
      segmentation_(monitor.stage("segmentation", budget)) {}

void PerceptionTask::tick(Tick& tick) {
  newest_ = pace_.take_newest(pictures, tick, figures_.passed);
  if (newest_ == nullptr || tick.regime() == Regime::kDrain) return;
  const auto overloaded = [this] { return shed_() >= safety::Shed::kSemantics ? 1 : 0; };
  if (tick.decide(shed_slot, overloaded, 0) != 0)
    ++figures_.shed;
  else
    look(tick);
}

void PerceptionTask::look(Tick& tick) {
  const auto found = segment();
  if (!found) return refuse(found.error());
  ++figures_.images;
  if (tap_) tap_(**found);
  ArrivedLabels* out = labels.back(tick);
  if (out == nullptr) return monitor_.event((*found)->stamp, "perception", "labels were dropped: mapping is behind");
  out->labels = **found;
  labels.push(tick);
}

Result<const LabelImage*> PerceptionTask::segment() {
  const StageTimer timing(segmentation_);
  const auto seen = parts_.reader->read(*newest_);
  if (!seen) return seen.error();
  return parts_.segmenter->segment(**seen);
}

void PerceptionTask::refuse(const Error& error) {
  if (error.code == Errc::kNotFound) {
    ++figures_.unlabelled;
    return;
  }
  ++figures_.refused;
  monitor_.event(newest_->arrival, "perception", to_string(error));
}

}  // namespace cairn::app
