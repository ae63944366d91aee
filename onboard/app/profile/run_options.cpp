// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/run_options.hpp"

#include <string>

namespace cairn::app {

Result<void> check(const RunOptions& options) {
  std::string detail;
  const auto refuse = [&](bool given, const char* why) { detail += given ? std::string("\n  ") + why : ""; };
  refuse(options.networks == NetworkUse::kRecorded && options.recording.empty(),
         "--networks recorded takes the labels of a recording: name a --recording, too");
  if (options.live()) {
    refuse(!options.schedule.empty(), "--schedule repeats the schedule of another run: name a --recording, too");
  } else {
    refuse(!options.record.empty(), "--record keeps what devices send: leave it out, the recording is there already");
    refuse(!options.state.empty(), "--state keeps the map of a live run: leave it out, the map goes to --out");
    refuse(!options.sockets.empty(), "--sockets serves a live run: leave it out, or play the recording with --peers");
    refuse(!options.live_view.empty(),
           "--live-view serves a live run: leave it out, or play the recording with --peers");
  }
  if (detail.empty()) return {};
  return Error{Errc::kInvalidConfig,
               "these options cannot be used in this kind of run",
               options.live() ? "live" : options.recording.string(),
               {},
               detail};
}

}  // namespace cairn::app
