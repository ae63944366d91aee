// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/doctor/machine.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "drivers/camera/frame.hpp"
#include "drivers/camera/v4l2_stream.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using Level = Finding::Level;

constexpr const char* kRules =
    "sudo cp config/udev/60-cairn.rules /etc/udev/rules.d/ && sudo udevadm control --reload && sudo udevadm trigger";
constexpr int kShortQueue = 16;                // frames; see drivers/drive/can/socketcan_link.hpp
constexpr long long kReceiveBuffer = 4 << 20;  // bytes, as the LiDAR's profile asks for

/// The first line of a small file of sysfs or proc.
std::string line_of(const fs::path& path) {
  std::string line;
  std::getline(std::ifstream(path), line);
  return line;
}

std::optional<long long> number_of(const fs::path& path) {
  long long value = 0;
  if (std::ifstream(path) >> value) return value;
  return std::nullopt;
}

/// The names in a folder that begin so, sorted.
std::vector<std::string> names_in(const fs::path& folder, const std::string& prefix) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().filename().string().starts_with(prefix)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

bool may_use(const fs::path& device) { return ::access(device.c_str(), R_OK | W_OK) == 0; }

/// The name that does not change when the device is plugged in again.
std::string lasting_name(const fs::path& root, const std::string& device) {
  std::error_code error;
  for (const auto& link : fs::directory_iterator(root / "dev/v4l/by-id", error))
    if (fs::read_symlink(link.path(), error).filename() == device)
      return "/dev/v4l/by-id/" + link.path().filename().string();
  return "/dev/" + device;
}

/// What of a camera's modes Cairn can use; test devices offer thousands.
std::string offer_of(const fs::path& device) {
  const auto offered = camera::offered_modes(camera::kernel_calls(), device.string());
  if (offered.empty()) return "no capture device";
  std::vector<camera::OfferedMode> usable;
  std::copy_if(offered.begin(), offered.end(), std::back_inserter(usable),
               [](const camera::OfferedMode& mode) { return camera::find_format(mode.format) != nullptr; });
  if (usable.empty()) return "offers no format that is known: " + to_string(offered);
  return "offers " + to_string(usable);
}

Finding examine_interface(const fs::path& folder, const std::string& name) {
  const std::string state = line_of(folder / "operstate");
  const auto queue = number_of(folder / "tx_queue_len").value_or(0);
  if (state == "down")
    return {Level::kProblem, name + ": CAN interface, down",
            fmt::format(
                "sudo ip link set {0} type can bitrate 500000 restart-ms 100 && sudo ip link set {0} txqueuelen {1} "
                "up",
                name, kShortQueue)};
  if (queue > kShortQueue && !name.starts_with("vcan"))
    return {Level::kNote,
            fmt::format("{}: CAN interface, {}; its queue of {} frames would deliver old commands late", name, state,
                        queue),
            fmt::format("sudo ip link set {} txqueuelen {}", name, kShortQueue)};
  return {Level::kOk, fmt::format("{}: CAN interface, {}", name, state), {}};
}

Finding examine_limit(const char* name, decltype(RLIMIT_NICE) resource, const char* limit, rlim_t needed) {
  rlimit value{};
  ::getrlimit(resource, &value);
  if (::geteuid() == 0 || value.rlim_cur == RLIM_INFINITY || value.rlim_cur >= needed)
    return {Level::kOk, std::string(name) + ": allowed", {}};
  return {Level::kNote, fmt::format("{}: not allowed for this user (ulimit {})", name, value.rlim_cur),
          fmt::format("add `{} - {} {}` to /etc/security/limits.d/cairn.conf and log in again", "@realtime", limit,
                      needed == RLIM_INFINITY ? "unlimited" : std::to_string(needed))};
}

}  // namespace

Findings examine_cameras(const fs::path& root) {
  Findings findings;
  const fs::path known = root / "sys/class/video4linux";
  for (const std::string& device : names_in(known, "video")) {
    if (number_of(known / device / "index").value_or(0) != 0) continue;  // a camera's further nodes hold metadata
    const std::string title = lasting_name(root, device) + ": " + line_of(known / device / "name");
    const fs::path path = root / "dev" / device;
    if (!may_use(path)) {
      findings.push_back({Level::kProblem, title + ", which this user may not open", kRules});
      continue;
    }
    findings.push_back({Level::kOk, title + ", " + offer_of(path), {}});
  }
  if (findings.empty()) findings.push_back({Level::kOk, "cameras: none plugged in", {}});
  return findings;
}

Findings examine_can(const fs::path& root) {
  constexpr long long kArphrdCan = 280;
  Findings findings;
  const fs::path known = root / "sys/class/net";
  for (const std::string& name : names_in(known, ""))
    if (number_of(known / name / "type") == kArphrdCan) findings.push_back(examine_interface(known / name, name));
  if (findings.empty()) findings.push_back({Level::kOk, "CAN: no interface", {}});
  return findings;
}

Findings examine_gpio(const fs::path& root) {
  Findings findings;
  for (const std::string& name : names_in(root / "dev", "gpiochip")) {
    if (may_use(root / "dev" / name))
      findings.push_back({Level::kOk, "/dev/" + name + ": GPIO chip", {}});
    else
      findings.push_back({Level::kProblem, "/dev/" + name + ": GPIO chip, which this user may not open", kRules});
  }
  if (findings.empty()) findings.push_back({Level::kOk, "GPIO: no chip", {}});
  return findings;
}

Findings examine_real_time(const fs::path& root) {
  Findings findings;
  if (number_of(root / "sys/kernel/realtime").value_or(0) == 1)
    findings.push_back({Level::kOk, "kernel: PREEMPT_RT", {}});
  else
    findings.push_back({Level::kNote, "kernel: without PREEMPT_RT, ticks may come some milliseconds late",
                        "sudo apt install linux-image-rt-amd64 (or -arm64)"});
  const std::string governor = line_of(root / "sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  if (!governor.empty() && governor != "performance")
    findings.push_back({Level::kNote, "processor: governor " + governor + " changes its clock under load",
                        "sudo cpupower frequency-set -g performance"});
  const auto buffer = number_of(root / "proc/sys/net/core/rmem_max");
  if (buffer && *buffer < kReceiveBuffer)
    findings.push_back(
        {Level::kNote,
         fmt::format("receive buffer: at most {} kB, a pause of a second loses LiDAR packets", *buffer / 1024),
         fmt::format("sudo sysctl -w net.core.rmem_max={}", kReceiveBuffer)});
  findings.push_back(examine_limit("locked memory", RLIMIT_MEMLOCK, "memlock", RLIM_INFINITY));
  findings.push_back(examine_limit("real-time priority", RLIMIT_RTPRIO, "rtprio", 80));
  return findings;
}

}  // namespace cairn::cli
