// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/restart.hpp"

#include <algorithm>
#include <string_view>

#include "hal/files/file.hpp"

namespace cairn::app {
namespace {

constexpr std::uint64_t kMaxBootId = 128;

/// Empty: nothing speaks against it.
std::string_view objection(const Generation& saved, const RestartProfile& profile, const Successor& by, Time now) {
  const SavedState& state = saved.state;
  if (state.boot.empty() || state.boot != boot_id()) return "the machine was started since";
  if (state.stamp > now || now - state.stamp > from_seconds(profile.within_s)) return "it is too old";
  if (saved.map->getResolution() != by.resolution_m) return "it has another resolution";
  if (saved.newest_epoch != state.epoch) return "a newer one was begun";
  if (by.sees_its_way && saved.keyframes.empty()) return "no keyframes were saved with it";
  if (!by.sees_its_way && saved.scans.empty()) return "no scans were saved with it";
  return {};
}

}  // namespace

void declare(config::Section& s, RestartProfile& p) {
  s.number("save_map_every_s", p.save_map_every_s, {1, 3600}, "s",
           "with --state: from one save of the map to the next");
  s.number(
      "within_s", p.within_s, {0, 3600}, "s",
      "with --state: a run that starts at most so long after the last pose goes on in the saved map; the robot must "
      "not be carried away meanwhile. 0: never");
}

std::string boot_id() {
  // A file of /proc has no size: read_file() would find it empty.
  std::string id;
  if (std::FILE* file = std::fopen("/proc/sys/kernel/random/boot_id", "re")) {
    id.resize(kMaxBootId);
    id.resize(std::fread(id.data(), 1, id.size(), file));
    std::fclose(file);
  }
  id.resize(std::min(id.size(), id.find('\n')));
  return id;
}

PreviousRun find_previous_run(Generations& generations, const RestartProfile& profile, const Successor& successor,
                              Time now, Monitor& monitor) {
  PreviousRun previous;
  auto saved = generations.load(now);
  previous.state_lost = !saved && generations.damaged();
  if (!saved) return previous;
  previous.epoch = saved->newest_epoch;
  const std::string_view why_not = objection(*saved, profile, successor, now);
  if (why_not.empty())
    previous.resumed = std::move(*saved);
  else
    monitor.event(now, "restart", "begins anew, not in the saved map: " + std::string(why_not));
  return previous;
}

Resume resume(const Generation& saved) {
  return {.map = *saved.map,
          .map_stamp = saved.map_stamp,
          .scans = saved.scans,
          .T_odom_base = saved.state.T_odom_base,
          .twist = saved.state.twist,
          .stamp = saved.state.stamp,
          .keyframes = saved.keyframes};
}

Result<void> keep_with_recording(const std::filesystem::path& recording, const Generation& generation,
                                 Monitor& monitor) {
  Generations folder(recording / kResumeFolder, monitor);
  SavedState of_map = generation.state;
  of_map.stamp = generation.map_stamp;
  if (auto saved = folder.save(*generation.map, of_map); !saved) return saved;
  if (auto saved = folder.save_state(generation.state); !saved) return saved;
  if (auto saved = folder.save_scans({generation.state.epoch, generation.scans}); !saved) return saved;
  if (generation.keyframes.empty()) return {};
  return folder.save_keyframes({generation.state.epoch, generation.keyframes});
}

std::optional<Generation> resumed_in_recording(const std::filesystem::path& recording, Monitor& monitor) {
  if (!std::filesystem::is_directory(recording / kResumeFolder)) return std::nullopt;
  auto saved = Generations(recording / kResumeFolder, monitor).load({});
  if (!saved || (saved->scans.empty() && saved->keyframes.empty())) {
    monitor.event({}, "restart", "the recording's resume folder is damaged: not the same result");
    return std::nullopt;
  }
  return saved;
}

}  // namespace cairn::app
