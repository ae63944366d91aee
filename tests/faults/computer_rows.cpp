// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <string>

#include "onboard/app/restart/generations.hpp"
#include "onboard/app/restart/start_log.hpp"
#include "onboard/app/tasks/mapping_task.hpp"
#include "onboard/safety/failsafe.hpp"
#include "onboard/safety/health.hpp"
#include "onboard/safety/overload.hpp"
#include "onboard/scheduler/overrun.hpp"
#include "onboard/scheduler/task_graph.hpp"
#include "tests/faults/campaign.hpp"
#include "tests/support/failing_disk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::faults {
namespace {

using namespace std::chrono_literals;

/// The pipeline at 10 Hz: overloaded by half for ten seconds.
Measured overload() {
  safety::OverloadController controller{safety::OverloadConfig{}};
  Measured m;
  int worst_level = 0;
  for (Time now{}; now < Time{20s}; now += 100ms) {
    const bool heavy = now >= Time{5s} && now < Time{15s};
    const int before = static_cast<int>(controller.level());
    const int level = static_cast<int>(controller.step(now, {heavy ? 1.5 : 0.5, 0}));
    m.held = m.held && std::abs(level - before) <= 1;
    worst_level = std::max(worst_level, level);
    if (level > 0 && !m.detect) m.detect = now - Time{5s};
    if (level == 0 && m.detect && now >= Time{15s} && !m.recover) m.recover = now - Time{15s};
  }
  m.held = m.held && worst_level == safety::kShedLevels - 1;
  safety::Failsafe failsafe({}, {});
  safety::FailsafeInputs in;
  in.faults = {safety::Fault::kOverload};
  m.worst = failsafe.step(in).mode;
  return m;
}

/// The first sign within the fault's time, and the first of normal operation after it.
void note(Measured& m, safety::Mode mode, Time now, Time begin, Time end) {
  m.worst = std::max(m.worst, mode);
  if (mode != safety::Mode::kNormal && !m.detect) m.detect = now - begin;
  if (mode == safety::Mode::kNormal && m.detect && now >= end && !m.recover) m.recover = now - end;
}

safety::Mode step(safety::Failsafe& failsafe, Time now, safety::Fault fault, bool active) {
  safety::FailsafeInputs in;
  in.now = now;
  in.faults.set(fault, active);
  return failsafe.step(in).mode;
}

/// The real mapping task, given scans as late as the test says.
struct LateMapping {
  static constexpr Duration kDeadline = std::chrono::milliseconds(100);

  struct Odometry final : scheduler::Task {
    void tick(scheduler::Tick& /*tick*/) override {}
    scheduler::OutputPort<app::ArrivedMotion> motions{*this, "motions"};
  };

  LateMapping() {
    graph.add({.name = "odometry"}, odometry);
    graph.add({.name = "mapping"}, task);
    graph.connect(odometry.motions, task.motions, {.capacity = 4});
  }

  safety::Shed map_scan(Time arrival, Duration late) {
    clock.advance_to(arrival + late);
    scheduler::TickRecord sent, record;
    sent.index = record.index = scans++;
    scheduler::Tick sending(scheduler::Regime::kLive, arrival, sent);
    app::ArrivedMotion* motion = odometry.motions.back(sending);
    motion->arrival = motion->scan.stamp = arrival;
    motion->scan.points_base.assign(8, {5, 0, 1});
    odometry.motions.push(sending);
    scheduler::Tick tick(scheduler::Regime::kLive, arrival, record, nullptr, &clock);
    task.tick(tick);
    logged = logged && record.slots[task.shed_slot] == static_cast<std::int32_t>(task.shed());
    return task.shed();
  }

  Monitor monitor;
  Workers one{1}, other{1};
  Robot robot{{}, one, other, monitor};
  Odometry odometry;
  app::MappingTask task{{}, kDeadline, robot, monitor};
  scheduler::TaskGraph graph;
  VirtualClock clock;
  std::uint64_t scans = 0;
  bool logged = true;
};

/// Another process takes the CPU for ten seconds: each scan is mapped 1.5 deadlines after its last byte.
Measured hog() {
  LateMapping late;
  safety::Failsafe failsafe({}, {});
  Measured m;
  int before = 0, worst_level = 0;
  for (Time now{}; now < Time{20s}; now += 100ms) {
    const bool hogged = now >= Time{5s} && now < Time{15s};
    const int level = static_cast<int>(late.map_scan(now, (hogged ? 3 : 1) * LateMapping::kDeadline / 2));
    m.held = m.held && std::abs(level - before) <= 1;
    before = level;
    worst_level = std::max(worst_level, level);
    note(m, step(failsafe, now, safety::Fault::kOverload, level > 0), now, Time{5s}, Time{15s});
  }
  std::uint64_t mapped = 0;
  for (const RelaxedCounter& scans : late.task.scans_at()) m.held = m.held && scans > 0, mapped += scans;
  m.held = m.held && worst_level == safety::kShedLevels - 1 && mapped == late.scans && late.logged;
  return m;
}

/// A stage of 10 Hz that needs more than its hard budget for three seconds.
Measured overruns() {
  scheduler::OverrunPolicy policy(40ms, 80ms);
  safety::Failsafe failsafe({}, {});
  Measured m;
  std::uint64_t skip = 0;
  for (Time now{}; now < Time{15s}; now += 100ms * (1 + skip)) {
    const bool heavy = now >= Time{5s} && now < Time{8s};
    skip = policy.tick(heavy ? 90ms : 20ms, true).skip;
    m.held = m.held && (!heavy || skip == 1);
    note(m, step(failsafe, now, safety::Fault::kStageDemoted, policy.demoted()), now, Time{5s}, Time{8s});
  }
  return m;
}

/// A task of 10 Hz with a limit of 300 ms under a supervisor that looks every 100 ms.
Measured hang() {
  RelaxedCounter beats;
  safety::Supervisor supervisor({{"mapping", 300ms, &beats}});
  safety::Failsafe failsafe({}, {});
  Measured m;
  for (Time now{}; now < Time{10s}; now += 100ms) {
    const bool hangs = now >= Time{4s} && now < Time{6s};
    beats += hangs ? 0U : 1U;
    note(m, step(failsafe, now, safety::Fault::kTaskHung, supervisor.step(now).has_value()), now, Time{4s}, Time{6s});
  }
  return m;
}

/// The map is saved every second; the disk is full for five seconds.
Measured disk(int error) {
  const support::TemporaryFolder folder;
  support::FailingDisk disk;
  Monitor monitor;
  app::Generations generations(folder.path(), monitor, disk);
  mapping::SemanticOcTree map(0.1);
  map.updateNode(octomap::point3d(1, 1, 1), true);
  Measured m;
  for (Time now{}; now < Time{15s}; now += 1s) {
    const bool sick = now >= Time{5s} && now < Time{10s};
    if (sick)
      disk.fail(0, error, true);
    else
      disk.heal();
    app::SavedState state;
    state.stamp = now;
    const bool saved = generations.save(map, state).has_value();
    if (!saved && !m.detect) m.detect = now - Time{5s};
    if (saved && m.detect && !m.recover) m.recover = now - Time{10s};
    const auto newest = app::Generations(folder.path(), monitor).load(now);
    m.held = m.held && saved != sick && newest && newest->state.stamp >= std::min(now, Time{4s});
  }
  m.held = m.held && monitor.events().empty();
  safety::Failsafe failsafe({}, {});
  safety::FailsafeInputs in;
  in.faults = {safety::Fault::kDiskFailing};
  m.worst = failsafe.step(in).mode;
  return m;
}

Measured crash_loop() {
  const support::TemporaryFolder folder;
  app::StartLog log(folder / "starts");
  Measured m;
  Time now{100s};
  for (int start = 0; start < 6; ++start, now += 2s) {
    safety::FailsafeInputs in;
    in.faults.set(safety::Fault::kCrashLoop, log.begin(now, "boot"));
    safety::Failsafe failsafe({}, {});
    m.worst = failsafe.step(in).mode;
    if (m.worst == safety::Mode::kStop && !m.detect) m.detect = now - Time{100s};
  }
  return m;
}

std::vector<Row> late_rows() {
  constexpr safety::Mode D = safety::Mode::kDegraded, H = safety::Mode::kHold;
  return {
      {"C1", "the pipeline needs 1.5 times its budget for 10 s",
       "Work is left out level by level. All of it is back within 1 s.", 500ms, 1s, D, "", overload},
      {"C2", "a task hangs", "It is found within its limit plus one check. Its name is logged before the process ends.",
       400ms, 100ms, H, "", hang},
      {"C15", "a stage needs more than its hard budget for 3 s",
       "An overrun costs the next release. Three in a row halve the rate. Ten good ticks in a row restore it.", 600ms,
       2100ms, D, "", overruns},
      {"C16", "another process takes the CPU for 10 s: scans are mapped after 1.5 deadlines",
       "The mapping task leaves work out level by level. All of it is back within 1 s.", 500ms, 1s, D, "", hog},
      {"C18", "a task does not return (real threads)",
       "The task is named. systemd gets no sign of life. The other tasks go on. The fault ends with its cause.", 0ms,
       0ms, H, "faults/HungTask.IsNamedAndTheOthersGoOn"},
      {"C19", "a worker thread of a stage is stopped in the middle of its work", "As for C18. The stage is named.", 0ms,
       0ms, H, "faults/HungTask.IsTheStageWhoseHelperIsStopped"},
      {"C20", "the safety task misses a deadline", "Hold until it keeps its deadlines again.", 0ms, 0ms, H,
       "app/ScheduleFaults.AMissOfTheSafetyTaskIsAFaultUntilTheNextLook"},
  };
}

std::vector<Row> disk_rows() {
  constexpr safety::Mode N = safety::Mode::kNormal;
  return {
      {"C3", "disk full", "The next save reports it. A whole saved map always exists. Saving works again by itself.",
       1s, 1s, N, "", [] { return disk(ENOSPC); }},
      {"C4", "disk errors (EIO)", "As for C3.", 1s, 1s, N, "", [] { return disk(EIO); }},
      {"C5", "file system read-only", "As for C3.", 1s, 1s, N, "", [] { return disk(EROFS); }},
      {"C7", "any system call of a save fails", "A whole saved map always exists. The next save works.", 0ms, 0ms, N,
       "generations/GenerationsTest.WhateverCallFailsThereIsAWholeGenerationAndTheNextSaveWorks"},
      {"C8", "saved map damaged in any byte, or cut anywhere", "The previous saved map is loaded, with an event.", 0ms,
       0ms, N, "generations/GenerationsTest.EveryDamagedByteGivesTheGenerationBeforeWithAnEvent"},
      {"C9", "memory refused at any allocation of a save", "The save is an error. A whole saved map always exists.",
       0ms, 0ms, N, "failing_malloc/FailingMalloc.ASaveThatGetsNoMemoryIsAnErrorAndKeepsTheGenerationBefore"},
      {"C13", "saved pose with any damage", "The pose that was saved with the map is used, with an event.", 0ms, 0ms, N,
       "generations/GenerationsTest.ADamagedPoseIsAnEventAndTheMapsOwnIsTaken"},
      {"C17", "disk that does not answer",
       "Safety and signs of life go on, without an allocation. Packets wait in bounded memory, the rest is counted. "
       "An event names the disk.",
       0ms, 0ms, N, "faults/SlowDiskTest.CostsTheRealTimeTasksNothing"},
  };
}

std::vector<Row> foreign_rows() {
  constexpr safety::Mode N = safety::Mode::kNormal;
  return {
      {"C21", "a valid map of a few nodes that span the whole tree",
       "Each command works on cubes, or refuses at once. Time and memory stay bounded.", 0ms, 0ms, N,
       "cli/HostileMaps.AreDescribedDrawnAndCompared"},
      {"C22", "a pipe, device, socket or folder in the place of a file", "It is refused at once, with the remedy.", 0ms,
       0ms, N, "hal/InputFile.RefusesWhatIsNoRegularFileAtOnce"},
      {"C23", "eight clients of the live view that read nothing", "A new client takes the place of one of them.", 0ms,
       0ms, N, "live/LiveServerTest.SilentClientsLockNobodyOut"},
      {"C29", "clients of robot.sock that read nothing, send garbage, or die",
       "The run is what it is without them. Garbage ends a connection, with an event.", 0ms, 0ms, N,
       "streams/LiveStreams.HostileClientsChangeNothing"},
      {"C30", "a client of robot.sock that does not read for a while",
       "It misses no tile. Of other records it loses some, and counts them.", 0ms, 0ms, N,
       "streams/TileStreamTest.WhoDoesNotReadMissesNoTile"},
      {"C31", "clients and cairn-ros are killed at random instants, a thousand times",
       "The core notices nothing but their absence: no event of clients, no open file.", 0ms, 0ms, N,
       "client_kills/FullClientKills.AThousandTimes"},
      {"C32", "a mirror of the map is away for 30 s", "It has each tile, to the bit, within 2 s of its return.", 0ms,
       0ms, N, "streams/TileStreamTest.AfterThirtySecondsAwayAMirrorHasEveryTileWithinTwo"},
      {"C33", "a picture stream's reader is slow", "It loses whole pictures, and no pose.", 0ms, 0ms, N,
       "streams/PictureStreamTest.WhoDoesNotReadLosesPicturesAndNoPoses"},
      {"C34", "the trigger of a triggered camera is silent",
       "Its pictures keep the time of their arrival. An event says so.", 0ms, 0ms, N,
       "app/ReceiveTaskTest.ATriggeredPictureHasTheTimeOfItsPulse"},
  };
}

std::vector<Row> process_rows() {
  constexpr safety::Mode N = safety::Mode::kNormal, S = safety::Mode::kStop;
  return {
      {"C6", "crash loop: a restart every 2 s",
       "From the fourth start within a minute on, the drive stays off. Telemetry goes on.", 10s, 0ms, S, "",
       crash_loop},
      {"C10", "kill -9 at random instants while maps are saved",
       "A whole saved map exists. It is never older than the last confirmed one.", 0ms, 0ms, S,
       "faults/KillCampaign.AWholeMapIsThereAfterEveryKill"},
      {"C11", "SIGSTOP of the whole core",
       "No task is blamed afterwards. systemd's watchdog kills a core that stays stopped.", 0ms, 0ms, N,
       "watchdog/Supervisor.AMachineThatStoodAccusesNobody"},
      {"C12", "a client of the live view is slow or dies", "The client is dropped. The core never waits for it.", 0ms,
       0ms, N, "live/LiveServerTest.ASlowClientIsDroppedAndTheOthersAreServed"},
      {"C14", "restart in the middle of a drive", "The trajectory goes on with an error below one voxel.", 0ms, 0ms, N,
       "robot/Scenes/Resumed.TheTrajectoryGoesOn"},
  };
}

}  // namespace

std::vector<Row> computer_rows() {
  std::vector<Row> all;
  for (auto& rows : {late_rows(), disk_rows(), process_rows(), foreign_rows(), output_rows()})
    all.insert(all.end(), rows.begin(), rows.end());
  const auto number = [](const Row& row) { return std::stoi(row.id.substr(1)); };
  std::sort(all.begin(), all.end(), [&](const Row& a, const Row& b) { return number(a) < number(b); });
  return all;
}

}  // namespace cairn::faults
