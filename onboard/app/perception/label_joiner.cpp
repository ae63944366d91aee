// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/label_joiner.hpp"

#include <string>

namespace cairn::app {

LabelJoiner::LabelJoiner(Robot& robot, Monitor& monitor) : robot_(robot), monitor_(monitor) {}

void LabelJoiner::add(LabelImage& labels) {
  if (waiting_.size() == kWaiting) {
    leave_out(waiting_.front(), "no scan came after the picture for a long time: its labels are left out");
    waiting_.pop();
  }
  waiting_.add(labels);
}

void LabelJoiner::join(const scheduler::Tick& tick) {
  for (; !waiting_.empty(); waiting_.pop()) {
    const Time exposed = waiting_.front().stamp;
    if (exposed > tick.release() + kAhead) {
      leave_out(waiting_.front(), "the picture's time is in the future: its labels are left out; check its clock");
      continue;
    }
    if (robot_.before_map(exposed)) {
      ++figures_.apart;  // at every start
      continue;
    }
    const auto written = robot_.label_map(waiting_.front());
    if (written && !*written) return;  // the scan after the picture is still to come
    if (written)
      count(**written, waiting_.front(), tick);
    else
      leave_out(waiting_.front(), to_string(written.error()));
  }
}

void LabelJoiner::leave_out(const LabelImage& labels, const std::string& why) {
  ++figures_.apart;
  monitor_.event(labels.stamp, "perception", why);
}

void LabelJoiner::count(const mapping::LabelReport& report, const LabelImage& labels, const scheduler::Tick& tick) {
  ++figures_.images;
  figures_.points += report.points;
  figures_.voxels += report.voxels;
  if (tick.takes_time()) monitor_.stage(kPictureToMap).record(tick.figure_now() - labels.stamp);
}

}  // namespace cairn::app
