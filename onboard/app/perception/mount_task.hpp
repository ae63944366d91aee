// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/app/perception/arrived_picture.hpp"
#include "onboard/app/perception/arrived_pose.hpp"
#include "onboard/app/perception/picture_pace.hpp"
#include "onboard/app/perception/picture_reader.hpp"
#include "onboard/app/perception/waiting_list.hpp"
#include "onboard/perception/labelling/located_scans.hpp"
#include "onboard/perception/mount/mount_watch.hpp"
#include "onboard/perception/people/people.hpp"
#include "onboard/safety/overload.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// A camera whose mount is watched.
struct MountParts {
  people::Eye eye = people::Eye::kVisible;
  std::string source;  ///< id of the camera in the recording
  std::unique_ptr<PictureReader> reader;
  mount::MountWatch watch;
  Duration period{};  ///< at least so long from one picture to the next
};

/// Pictures and poses in: says whether a camera still looks where its mount says. A picture waits for the scan after
/// it. The task has a thread of its own, below mapping; nothing waits for it.
class MountTask final : public scheduler::Task {
 public:
  static constexpr std::size_t kWaiting = 4;  ///< pictures of each camera; of more, the oldest is left out

  // Slots in schedule.log, in this order.
  scheduler::InputPort<ArrivedPicture> pictures{*this, "pictures"};  ///< of the colour camera
  scheduler::InputPort<ArrivedPicture> thermals{*this, "thermals"};  ///< of the thermal camera
  scheduler::InputPort<ArrivedPose> poses{*this, "poses"};
  const std::size_t shed_slot = take_slots();  ///< 1: overload, pictures are left out

  /// What became of the pictures of one camera. Any thread may read.
  struct Figures {
    RelaxedCounter images;   ///< looked at
    RelaxedCounter passed;   ///< newer ones were there, or it was not time yet
    RelaxedCounter shed;     ///< left out under overload
    RelaxedCounter refused;  ///< no picture, nothing to be seen on it, or no scans around it
  };
  /// One camera.
  struct Watched {
    explicit Watched(MountParts given) : parts(std::move(given)), pace(parts.period) {}
    MountParts parts;
    PicturePace pace;
    WaitingList<Packet> waiting;
    Figures figures;
    bool said = false;  // that it was moved
  };

  /// Live, `shed` is asked how much work is left out; any thread. `budget`: of one picture. `monitor` must outlive the
  /// task.
  MountTask(std::vector<MountParts> eyes, Duration budget, std::function<safety::Shed()> shed, Monitor& monitor);

  void tick(scheduler::Tick& tick) override;

  /// After the run.
  [[nodiscard]] const std::deque<Watched>& watched() const { return watched_; }

 private:
  void take_newest(Watched& eye, scheduler::Tick& tick, bool overloaded);
  void look_at_located(Watched& eye);
  void look(Watched& eye, const Packet& packet);
  void say_moved(Watched& eye, Time stamp);

  std::deque<Watched> watched_;
  labelling::LocatedScans poses_;  // scans without points
  std::function<safety::Shed()> shed_;
  Monitor& monitor_;
  StageStats& stage_;
};

}  // namespace cairn::app
