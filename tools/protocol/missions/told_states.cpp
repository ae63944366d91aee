// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/missions/told_states.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "fusion/peers/datagrams/datagram.hpp"
#include "fusion/peers/exchange_config.hpp"
#include "hal/files/file.hpp"

namespace cairn::protocol {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxPeopleBytes = 256U << 20U;      // a bound on memory
constexpr Duration kTold = std::chrono::milliseconds(500);  // docs/team.md: about twice a second

struct Row {
  double t = 0;
  peers::Bodies::Person person;
};

/// t,id,x,y,vx,vy,sigma_m,sightings
/// None where nobody was followed.
Result<std::vector<Row>> read_rows(const fs::path& file) {
  if (!fs::exists(file)) return std::vector<Row>();
  const auto bytes = read_file(file, kMaxPeopleBytes);
  if (!bytes) return bytes.error();
  std::istringstream text(std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()));
  std::vector<Row> rows;
  std::string line;
  std::getline(text, line);
  for (int number = 2; std::getline(text, line); ++number) {
    Row row;
    double sigma = 0;
    auto& p = row.person;
    if (std::sscanf(line.c_str(), "%lf,%u,%lf,%lf,%lf,%lf,%lf", &row.t, &p.id, &p.position_m.x(), &p.position_m.y(),
                    &p.velocity_m_s.x(), &p.velocity_m_s.y(), &sigma) != 7)
      return Error{
          Errc::kMalformed, "not a row of people", file.string(), {}, fmt::format("line {}: {}", number, line)};
    p.covariance *= sigma * sigma;
    rows.push_back(row);
  }
  return rows;
}

std::uint64_t bytes_of(peers::Bodies bodies) {
  peers::Datagram datagram;
  datagram.sender = 1;
  datagram.bodies = std::move(bodies);
  return peers::encode(datagram).bytes.size() + peers::ExchangeConfig{}.overhead_bytes;
}

}  // namespace

Result<std::uint64_t> told_state_bytes(const fs::path& run) {
  const auto poses = recording::read_tum(run / "trajectory.tum");
  if (!poses) return poses.error();
  const auto rows = read_rows(run / "people.csv");
  if (!rows) return rows.error();
  std::uint64_t bytes = 0;
  Time due = Time::min();
  std::size_t next = 0;
  for (const recording::StampedPose& pose : *poses) {
    peers::Bodies bodies;
    bodies.stamp = pose.stamp;
    bodies.robot.position_m = pose.pose.translation();
    for (constexpr double kSame = 0.01;
         next < rows->size() && (*rows)[next].t < to_seconds(pose.stamp.time_since_epoch()) + kSame; ++next)
      bodies.people.push_back((*rows)[next].person);
    if (pose.stamp < due) continue;
    due = pose.stamp + kTold;
    bytes += bytes_of(std::move(bodies));
  }
  return bytes;
}

}  // namespace cairn::protocol
