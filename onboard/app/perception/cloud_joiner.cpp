// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/cloud_joiner.hpp"

namespace cairn::app {

void CloudJoiner::add(DepthCloud& cloud) {
  if (waiting_.size() == kWaiting) {
    leave_out({Errc::kNotFound, "no scan came after the depth picture for a long time: it is left out", {}, {}, {}});
    waiting_.pop();
  }
  waiting_.add(cloud);
}

void CloudJoiner::join(const Joined& joined) {
  for (; !waiting_.empty(); waiting_.pop()) {
    if (robot_.before_map(waiting_.front().stamp)) {
      ++figures_.apart;  // at every start
      continue;
    }
    const auto put = robot_.extend_map(waiting_.front());
    if (put && !*put) return;  // the scan after the picture is still to come
    if (!put) {
      leave_out(put.error());
      continue;
    }
    ++figures_.clouds;
    figures_.points += waiting_.front().points_base.size();
    joined(waiting_.front().stamp, **put);
  }
}

void CloudJoiner::leave_out(const Error& why) {
  ++figures_.apart;
  monitor_.event(waiting_.front().stamp, "depth", to_string(why));
}

}  // namespace cairn::app
