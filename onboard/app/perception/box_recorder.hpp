// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hal/labels.hpp"
#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "hal/result.hpp"
#include "hal/spsc_queue.hpp"
#include "onboard/perception/networks/recorded/box_file.hpp"

namespace cairn::app {

/// Keeps what detectors said in boxes.csv of the recording of a live run. Each detection task hands boxes over and
/// waits for nothing; the housekeeping task writes them in the order of their stamps.
class BoxRecorder {
 public:
  /// How long a line waits for earlier ones of the other camera.
  static constexpr Duration kPatience = std::chrono::seconds(2);

  /// `recording`: the folder that is being written. `monitor` must outlive the recorder. Error kIo.
  [[nodiscard]] static Result<std::unique_ptr<BoxRecorder>> create(const std::filesystem::path& recording,
                                                                   Monitor& monitor);

  /// One more camera; `id`: of the recording's source. Before the run.
  std::size_t add(std::string id);
  /// On the thread of this camera's task. Boxes that find no room are lost to the recording.
  void keep(std::size_t camera, const Detections& boxes);
  /// On the housekeeping thread. An error of the disk ends the writing and nothing else.
  void write_waiting(Time now);
  /// After the run: the rest.
  void close(Time now);

 private:
  struct Camera {
    static constexpr std::size_t kWaiting = 32;  // pictures
    std::string id;
    SpscQueue<Detections> waiting{kWaiting};
    RelaxedCounter lost;
  };
  struct Line {
    std::size_t camera;
    Detections boxes;
  };
  BoxRecorder(networks::BoxWriter writer, Monitor& monitor) : writer_(std::move(writer)), monitor_(monitor) {}
  void take_over();
  void write_until(Time stamp, Time now);

  networks::BoxWriter writer_;
  Monitor& monitor_;
  std::deque<Camera> cameras_;
  std::vector<Line> lines_;  // in the order of their stamps
  std::uint64_t reported_ = 0;
  bool failed_ = false;
};

}  // namespace cairn::app
