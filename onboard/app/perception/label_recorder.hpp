// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "hal/labels.hpp"
#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "hal/result.hpp"
#include "hal/spsc_queue.hpp"
#include "onboard/perception/networks/recorded/label_folder.hpp"

namespace cairn::app {

/// Keeps what a network said in labels/ of the recording of a live run, so that a replay needs no network. The
/// perception task hands labels over and waits for nothing; the housekeeping task writes them.
class LabelRecorder {
 public:
  /// `recording`: the folder that is being written. `monitor` must outlive the recorder. Error kIo.
  [[nodiscard]] static Result<std::unique_ptr<LabelRecorder>> create(const std::filesystem::path& recording,
                                                                     Monitor& monitor);

  /// On the perception task's thread. Labels that find no room are lost to the recording.
  void keep(const LabelImage& labels);
  /// On the housekeeping thread, and after the run. An error of the disk ends the writing and nothing else.
  void write_waiting(Time now);

 private:
  LabelRecorder(networks::LabelFolderWriter writer, Monitor& monitor) : writer_(std::move(writer)), monitor_(monitor) {}

  static constexpr std::size_t kWaiting = 16;  // pictures
  networks::LabelFolderWriter writer_;
  Monitor& monitor_;
  SpscQueue<LabelImage> waiting_{kWaiting};
  RelaxedCounter lost_;
  std::uint64_t reported_ = 0;
  bool failed_ = false;
};

}  // namespace cairn::app
