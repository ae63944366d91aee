// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/doctor/robot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "onboard/app/checked_profile.hpp"
#include "onboard/app/door/devices.hpp"
#include "tools/cli/doctor/networks.hpp"
#include "tools/cli/inspect/inspect.hpp"

namespace cairn::cli {
namespace {

using Level = Finding::Level;

Finding problem(const std::string& who, const Error& error) {
  Error cause = error;
  const std::string remedy = std::exchange(cause.detail, {});
  return {Level::kProblem, who + ": " + to_string(cause), remedy};
}

const char* remedy_for_silence(recording::SensorKind kind) {
  if (kind == recording::kVelodyne)
    return "check cable and power; the sensor's web page says to which address and ports it sends";
  if (kind == recording::kDrive) return "check the bus' power, termination and bit rate: candump shows what is on it";
  return "check cable and power: another USB port or a powered hub";
}

/// Everything that came in the time that is given to one device.
Finding listen_to(app::Device& device, const recording::SourceEntry& entry, const Clock& clock, Duration listen) {
  Packet packet;
  std::uint64_t packets = 0;
  const Time end = clock.now() + listen;
  for (Time now = clock.now(); now < end; now = clock.now()) {
    const auto poll = device.source->next(packet, end - now);
    if (!poll) return problem(entry.id, poll.error());
    packets += *poll == Poll::kPacket ? 1 : 0;
  }
  const double seconds = to_seconds(listen);
  if (entry.kind == recording::kGpio)
    return {Level::kOk, fmt::format("{}: open, {} edges in {:.1f} s", entry.id, packets, seconds), {}};
  if (packets > 0)
    return {Level::kOk, fmt::format("{}: {:.0f} packets/s", entry.id, static_cast<double>(packets) / seconds), {}};
  return {Level::kProblem, fmt::format("{}: open, but silent for {:.1f} s", entry.id, seconds),
          remedy_for_silence(entry.kind)};
}

/// Datagrams of other senders on the LiDAR's ports.
std::optional<Finding> foreign_senders(const app::Device& device, Duration listen) {
  for (const auto& [name, count] : device.losses())
    if (name == "foreign" && count > 0)
      return Finding{
          Level::kNote,
          fmt::format("{}: {} datagrams of other senders in {:.1f} s were dropped, most of them in the kernel",
                      device.id, count, to_seconds(listen)),
          "find the sender (tcpdump -n udp), and set lidar.source_address to the sensor's address"};
  return std::nullopt;
}

Findings examine_device(const app::RobotProfile& profile, const recording::SourceEntry& entry, Duration listen) {
  const LiveClock clock;
  auto device = app::open_device(profile, entry, SourceId{0}, clock);
  if (!device) return {problem(entry.id, device.error())};
  Findings findings{listen_to(*device, entry, clock, listen)};
  if (auto foreign = foreign_senders(*device, listen)) findings.push_back(std::move(*foreign));
  return findings;
}

Finding examine_source(const report::Json& source) {
  const std::string id = source["id"].get<std::string>();
  const auto packets = source["packets"]["packets"].get<std::uint64_t>();
  if (packets == 0 && source["kind"] == to_string(recording::kGpio)) return {Level::kOk, id + ": no edge", {}};
  if (packets == 0)
    return {Level::kProblem, id + ": the recording holds nothing of it", "record again, after cairn doctor --config"};
  const auto missing = source["packets"].value("missing_sequence_numbers", std::uint64_t{0});
  std::uint64_t lost = missing;
  if (source.contains("velodyne")) lost += source["velodyne"]["lost_packets"].get<std::uint64_t>();
  if (lost == 0) return {Level::kOk, fmt::format("{}: {} packets, none lost", id, packets), {}};
  return {Level::kNote, fmt::format("{}: {} packets, {} lost before they were recorded", id, packets, lost),
          "look for a full receive buffer or a bad cable: cairn doctor"};
}

/// What cairn run checks before it opens a device. The faults of devices are told as they are opened.
Findings examine_for_run(const app::RobotProfile& profile, const std::filesystem::path& path) {
  Findings findings;
  if (const auto fits = app::check_schedule({}, profile); !fits) findings.push_back(problem("profile", fits.error()));
  if (findings.empty() && app::check_drivers(profile))
    findings.push_back({Level::kOk, "profile: " + path.string() + " is in order", {}});
  return findings;
}

}  // namespace

Findings examine_profile(const std::filesystem::path& path, Duration listen) {
  const auto profile = app::load_profile(path);
  if (!profile) return {problem("profile", profile.error())};
  Findings findings = examine_for_run(*profile, path);
  const auto entries = app::devices_of(*profile);
  if (entries.empty())
    findings.push_back(
        {Level::kProblem, "profile: it has no device", "name one: camera.capture.device, drive.interface, …"});
  else if (const auto runs = app::check_devices(*profile); !runs)
    findings.push_back(
        {Level::kNote, "profile: cairn run would not start: " + std::string(runs.error().cause), runs.error().detail});
  for (const auto& entry : entries)
    std::ranges::move(examine_device(*profile, entry, listen), std::back_inserter(findings));
  std::ranges::move(examine_networks(profile->perception.networks, path), std::back_inserter(findings));
  return findings;
}

Findings examine_recording(const std::filesystem::path& folder) {
  const auto found = inspect({.path = folder, .unfinished_is_damage = false});
  if (!found) return {problem("recording", found.error())};
  Findings findings;
  if (!found->contains("sources"))
    return {
        {Level::kProblem, "recording: " + folder.string() + " is no recording", "name a folder with recording.yaml"}};
  if (found->value("unfinished", false))
    findings.push_back(problem("recording", recording::unfinished_recording(folder)));
  for (const report::Json& source : (*found)["sources"]) findings.push_back(examine_source(source));
  for (const report::Json& damage : (*found)["damage"])
    findings.push_back(
        {Level::kProblem, "recording: " + damage.get<std::string>(), "what lies before and behind the damage is used"});
  return findings;
}

}  // namespace cairn::cli
