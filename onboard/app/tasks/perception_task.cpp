// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/perception_task.hpp"

#include <string>
#include <utility>

#include "onboard/perception/health/picture_health.hpp"

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
  const auto seen = picture();
  if (!seen) return seen.error();
  if (const auto fit = judge(**seen); !fit) return fit.error();
  return parts_.segmenter->segment(**seen);
}

/// A network has an answer for every picture, also for those on which nothing can be seen.
Result<void> PerceptionTask::judge(const Image& picture) {
  const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
  if (picture.width != parts_.width || picture.height != parts_.height)
    return Error{Errc::kMalformed,
                 "a picture of another size than camera.intrinsics are of",
                 {},
                 {},
                 size(picture.width, picture.height) + ", not " + size(parts_.width, parts_.height)};
  if (!parts_.judged) return {};
  if (stuck_.step(newest_->channel, newest_->payload()))
    return Error{Errc::kMalformed, "the camera is stuck: the same picture again and again", {}, {}, {}};
  const health::PictureState state = health::judge(health::figures_of(picture.view()));
  if (state == health::PictureState::kGood) return {};
  return Error{Errc::kMalformed, "not labelled", {}, {}, std::string(to_string(state))};
}

/// What is looked at of the newest packet.
Result<const Image*> PerceptionTask::picture() {
  const auto decoded = parts_.camera->decode(*newest_);
  if (!decoded || !parts_.side_by_side) return decoded;
  if (const auto cut = camera::left_eye(**decoded, left_); !cut) return cut.error();
  return &left_;
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
