// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "fusion/matching/belief/growing_match.hpp"
#include "hal/monitor.hpp"
#include "onboard/app/rejoin/rejoin_job.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// Compares the present map with earlier ones, one at a time, at the lowest priority. It follows them while the present
/// map grows, as robots of a team follow each other's: no single comparison decides.
class RejoinTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  scheduler::InputPort<RejoinJob> jobs{*this, "jobs"};
  const std::size_t steps_slot = take_slots();  ///< steps granted
  scheduler::OutputPort<RejoinJob> results{*this, "results"};

  /// `limit`: how long one comparison may take. `monitor` must outlive the task.
  RejoinTask(Duration limit, Monitor& monitor) : limit_(limit), stage_(monitor.stage("rejoining")) {}
  void tick(scheduler::Tick& tick) override;

 private:
  /// An earlier map and what is believed of its place in the present one.
  struct Followed {
    std::shared_ptr<const mapping::SemanticOcTree> map;  // features read it
    matching::MapFeatures features;
    matching::GrowingMatch match{};
  };
  [[nodiscard]] Followed* followed(const RejoinJob& job);
  void run(RejoinJob& job, Budget& budget);

  Duration limit_;
  StageStats& stage_;
  std::uint32_t present_epoch_ = 0;
  std::map<std::uint32_t, Followed> followed_;  // by their epochs
};

}  // namespace cairn::app
