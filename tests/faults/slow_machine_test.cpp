// SPDX-License-Identifier: Apache-2.0
// What does not come back: a disk, a task, a helper of a stage. Real threads under the real executive; the test says
// when each goes on, so that nothing depends on how fast the machine is.
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>

#include "drivers/gpio/line_event.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "hal/workers.hpp"
#include "onboard/app/live/watchdog.hpp"
#include "onboard/app/restart/generations.hpp"
#include "onboard/app/runs/allocations.hpp"
#include "onboard/app/tasks/housekeeping_task.hpp"
#include "onboard/app/tasks/watch_task.hpp"
#include "onboard/scheduler/execution/executive.hpp"
#include "tests/support/local_socket.hpp"
#include "tests/support/slow_disk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::faults {
namespace {

using namespace std::chrono_literals;
using scheduler::Executive;
using scheduler::ScheduledTask;
using scheduler::TaskGraph;
using scheduler::TaskRole;
using scheduler::Tick;

/// Ten edges of an e-stop's line at every tick, through a real feed and into the recorder's queue.
class EdgeReader final : public scheduler::Task {
 public:
  static constexpr int kEdges = 10;
  explicit EdgeReader(scheduler::Feed::Tap tap)
      : feed_(
            edges_, SourceId{0}, 0, [](Time, const Error&) {}, std::move(tap)) {}
  void tick(Tick& tick) override {
    const std::uint64_t before = app::allocations_of_this_thread();
    while (feed_.take(tick) != nullptr) ++taken;
    allocated += app::allocations_of_this_thread() - before;
  }
  RelaxedCounter taken, allocated;

 private:
  class Edges final : public Source {
   public:
    Result<Poll> next(Packet& packet, Duration /*timeout*/) override {
      if (left_ == 0) {
        left_ = kEdges;
        return Poll::kTimeout;
      }
      --left_;
      packet.arrival = Time{std::chrono::microseconds(++number_)};
      gpio::encode_event({gpio::Line::kEStop, number_ % 2 == 0, false, number_}, packet);
      return Poll::kPacket;
    }

   private:
    int left_ = kEdges;
    std::uint32_t number_ = 0;
  };
  Edges edges_;
  scheduler::Feed feed_;
};

recording::Recording gpio_recording() {
  recording::Recording index;
  index.robot = "husky_1";
  index.sources.push_back({"gpio", recording::kGpio, "gpio.csv", "base_link", ""});
  return index;
}

/// A reader, housekeeping that saves maps and records the edges, and the watch over it.
class SlowDiskTest : public testing::Test {
 protected:
  static constexpr std::size_t kQueue = 200;
  enum Phase { kWell, kSlow, kHealed };

  SlowDiskTest() {
    map_.updateNode(octomap::point3d(1, 1, 1), true);
    housekeeping_.add([this](Time now) {
      app::SavedState state;
      state.stamp = now;
      if (generations_.save(map_, state)) ++saved_;
    });
    watch_.add([this](Time) { failing_ = watch_.faults().has(safety::Fault::kDiskFailing) ? 1 : 0; });
  }

  /// The disk is slow until the reader has run a hundred ticks more and its queue has overflowed; over when maps are
  /// saved again.
  bool look() {
    if (phase_ == kWell && saved_ > 1) {
      lost_while_well_ = recorder_.lost();
      disk_.become_slow();
      phase_ = kSlow;
    }
    if (phase_ == kSlow && !disk_.busy()) read_then_ = reading_.stats.ticks, watched_then_ = watching_.stats.ticks;
    const bool went_on = reading_.stats.ticks > read_then_ + 100 && watching_.stats.ticks > watched_then_ + 10;
    if (phase_ == kSlow && disk_.busy() && failing_ == 1 && recorder_.lost() > lost_while_well_ && went_on) {
      saved_then_ = saved_;
      phase_ = kHealed;
      disk_.heal();
    }
    return phase_ == kHealed && failing_ == 0 && saved_ > saved_then_ + 1;
  }
  [[nodiscard]] std::uint64_t edges_on_disk() const {
    const auto recording = recording::load_recording(folder_ / "recording").value();
    const auto source = recording::open_recorded_source(folder_ / "recording", recording, 0).value();
    std::uint64_t edges = 0;
    Packet packet;
    while (*source->next(packet, {}) == Poll::kPacket) ++edges;
    return edges;
  }

  support::TemporaryFolder folder_;
  support::SlowDisk disk_;
  Monitor monitor_;
  const LiveClock clock_;
  app::Recorder recorder_{recording::RecordingWriter::create(folder_ / "recording", gpio_recording()).value(),
                          monitor_};
  EdgeReader reader_{recorder_.tap(kQueue, gpio::kEventBytes)};
  TaskGraph graph_;
  ScheduledTask& reading_ = graph_.add({.name = "safety", .rate_hz = 500}, reader_);
  app::HousekeepingTask housekeeping_{graph_, folder_ / "schedule.log", &recorder_};
  ScheduledTask& keeping_ = graph_.add({.name = "housekeeping", .rate_hz = 100}, housekeeping_, TaskRole::kLiveOnly);
  app::WatchTask watch_{{{"housekeeping", app::WatchTask::kDiskLimit, &keeping_.stats.ticks}}, &recorder_};
  ScheduledTask& watching_ = graph_.add({.name = "watch", .rate_hz = 100}, watch_, TaskRole::kLiveOnly);
  app::Generations generations_{folder_ / "maps", monitor_, disk_};
  mapping::SemanticOcTree map_{0.1};
  RelaxedCounter saved_, failing_;
  Phase phase_ = kWell;
  std::uint64_t read_then_ = 0, watched_then_ = 0, saved_then_ = 0, lost_while_well_ = 0;
};

/// Nobody but housekeeping waits, what does not fit is counted, and everything goes on when the disk does.
TEST_F(SlowDiskTest, CostsTheRealTimeTasksNothing) {
  Executive(graph_).run_live({clock_.now(), [this] { return look(); }}, clock_);
  ASSERT_TRUE(housekeeping_.close(clock_.now()));
  EXPECT_EQ(reader_.allocated, 0U);
  const std::uint64_t written = edges_on_disk();
  EXPECT_EQ(written + recorder_.lost(), reader_.taken) << "each is on the disk, or counted";
  EXPECT_GE(written, kQueue);
  ASSERT_EQ(monitor_.events().size(), 1U);
  EXPECT_EQ(monitor_.events()[0].stage, "recording") << "said once, at the end";
  EXPECT_TRUE(app::Generations(folder_ / "maps", monitor_).load(clock_.now())) << "a whole generation";
}

/// Stops in its tick until it is told to go on, as one that waits for what never comes.
class Hanger final : public scheduler::Task {
 public:
  void tick(Tick& /*tick*/) override {
    while (hang.load()) hang.wait(true);
  }
  void go_on() {
    hang = false;
    hang.notify_all();
  }
  std::atomic<bool> hang{false};
};

/// A stage of two threads, whose helper is stopped in the middle of its part, as by SIGSTOP or a debugger.
class Stage final : public scheduler::Task {
 public:
  void tick(Tick& /*tick*/) override {
    const auto caller = std::this_thread::get_id();
    workers_.for_each(64, [&](std::size_t) {
      if (std::this_thread::get_id() == caller) return;
      while (stop_helper.load()) stop_helper.wait(true);
    });
  }
  void go_on() {
    stop_helper = false;
    stop_helper.notify_all();
  }
  std::atomic<bool> stop_helper{false};

 private:
  Workers workers_{2};
};

/// Runs a task beside another under the watchdog. `hang` is called when it has run, `go_on` when it was named and the
/// other one has run fifty ticks since. The watchdog's time passes only while all run that do not hang: a machine with
/// other work to do makes nobody suspect.
class Supervised {
 public:
  using Act = std::function<void()>;
  Supervised(const char* name, scheduler::Task& task, Act hang, Act go_on)
      : supervised_(graph_.add({.name = name, .rate_hz = 100}, task)),
        hang_(std::move(hang)),
        go_on_(std::move(go_on)) {
    Executive(graph_).run_live({clock_.now(), [this] { return look(); }}, clock_);
  }

  std::string named, signs;  ///< as the watchdog says, and what the manager heard while the task hung
  Monitor monitor;

 private:
  static constexpr Duration kLook = 20ms;

  bool all_went_on() {
    const std::uint64_t safety = safety_.stats.ticks, line = supervised_.stats.ticks;
    if (safety == safety_seen_ || (line == line_seen_ && began_ == released_)) return false;
    safety_seen_ = safety, line_seen_ = line;
    return true;
  }
  bool look() {
    if (!all_went_on()) return false;
    const bool well = watchdog_.step(now_ += kLook, "");
    const std::string heard = manager_.next();
    if (!began_ && supervised_.stats.ticks > 5) hang_(), began_ = true;
    if (began_ && !well && named.empty()) named = watchdog_.hung(), ticks_then_ = safety_.stats.ticks;
    if (!named.empty() && !released_) {
      signs += heard;
      if (safety_.stats.ticks > ticks_then_ + 50) go_on_(), released_ = true;
    }
    return released_ && well;
  }

  support::TemporaryFolder folder_;
  support::DatagramListener manager_{(folder_ / "notify").string()};
  const LiveClock clock_;
  TaskGraph graph_;
  Hanger safety_task_;  // never does
  ScheduledTask& safety_ = graph_.add({.name = "safety", .rate_hz = 500}, safety_task_);
  ScheduledTask& supervised_;
  Act hang_, go_on_;
  app::Watchdog watchdog_{
      {{"safety", 300ms, &safety_.stats.ticks}, {supervised_.spec.name, 300ms, &supervised_.stats.ticks}},
      app::SdNotify::open((folder_ / "notify").string()).value(),
      1s,
      monitor};
  Time now_{};
  bool began_ = false, released_ = false;
  std::uint64_t ticks_then_ = 0, safety_seen_ = 0, line_seen_ = 0;
};

TEST(HungTask, IsNamedAndTheOthersGoOn) {
  Hanger mapping;
  const Supervised run(
      "mapping", mapping, [&] { mapping.hang = true; }, [&] { mapping.go_on(); });
  EXPECT_EQ(run.named.rfind("task mapping hangs", 0), 0U) << run.named;
  EXPECT_EQ(run.signs.find("WATCHDOG=1"), std::string::npos) << "meanwhile";
  EXPECT_EQ(run.monitor.events().size(), 1U);
}

TEST(HungTask, IsTheStageWhoseHelperIsStopped) {
  Stage stage;
  const Supervised run(
      "odometry", stage, [&] { stage.stop_helper = true; }, [&] { stage.go_on(); });
  EXPECT_EQ(run.named.rfind("task odometry hangs", 0), 0U) << run.named;
}

}  // namespace
}  // namespace cairn::faults
