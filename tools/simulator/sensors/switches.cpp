// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/switches.hpp"

#include <algorithm>

#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

constexpr std::uint64_t kBounceStream = 80;
constexpr int kBounces = 3;

std::vector<LineEdge> estop(Time start, std::uint64_t seed) {
  std::vector<LineEdge> edges{{start, {gpio::Line::kEStop, false, true, 0}}};  // as it is read when the program starts
  Random random(seed, kBounceStream);
  Time at = start + kEStopReleased;
  std::uint32_t sequence = 0;
  for (int i = 0; i < 2 * kBounces + 1; ++i) {
    edges.push_back({at, {gpio::Line::kEStop, i % 2 == 0, false, ++sequence}});
    at += from_seconds(random.uniform(50e-6, 900e-6));
  }
  return edges;
}

}  // namespace

Time exposure(Time start, double rate_hz, std::uint64_t n) {
  return start + from_seconds(static_cast<double>(n) / rate_hz);
}

std::vector<LineEdge> line_edges(Time start, Time end, double rate_hz, Duration pulse, std::uint64_t seed) {
  std::vector<LineEdge> edges = estop(start, seed);
  std::uint32_t sequence = 0;
  for (std::uint64_t n = 0; exposure(start, rate_hz, n) < end; ++n) {
    const Time rise = exposure(start, rate_hz, n);
    edges.push_back({rise, {gpio::Line::kTrigger, true, false, ++sequence}});
    edges.push_back({rise + pulse, {gpio::Line::kTrigger, false, false, ++sequence}});
  }
  std::stable_sort(edges.begin(), edges.end(), [](const LineEdge& a, const LineEdge& b) { return a.stamp < b.stamp; });
  std::erase_if(edges, [end](const LineEdge& e) { return e.stamp > end; });
  return edges;
}

}  // namespace cairn::simulator
