// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/figures/packet_figures.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

namespace cairn::cli {
namespace {

constexpr std::size_t kMaxSizes = 8;  // distinct payload sizes that are told apart

double rate(std::uint64_t packets, Duration duration) {
  return packets > 1 && duration > Duration::zero() ? static_cast<double>(packets - 1) / to_seconds(duration) : 0.0;
}

}  // namespace

void PacketFigures::add(const Packet& packet) {
  if (packets_ == 0) {
    first_ = packet.arrival;
  } else {
    if (packet.arrival < last_) ++backwards_;
    intervals_.record(std::max(packet.arrival - last_, Duration::zero()));
    missing_ += packet.sequence > next_sequence_ ? packet.sequence - next_sequence_ : 0;
  }
  last_ = packet.arrival;
  next_sequence_ = packet.sequence + 1;
  ++packets_;
  bytes_ += packet.bytes.size();
  truncated_ += packet.truncated ? 1 : 0;
  Channel& channel = channels_[packet.channel];
  ++channel.packets;
  const std::size_t size = packet.bytes.size();
  if (channel.sizes.contains(size) || channel.sizes.size() < kMaxSizes)
    ++channel.sizes[size];
  else
    ++channel.other_sizes;
}

std::uint64_t PacketFigures::gaps(Duration longer_than) const {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < Histogram::kBuckets; ++i)
    if (const auto bucket = intervals_.bucket(i); bucket.lower > longer_than) n += bucket.count;
  return n;
}

report::Json PacketFigures::to_json() const {
  const Duration duration = last_ - first_, median = intervals_.percentile(0.5);
  report::Json json{{"packets", packets_},
                    {"bytes", bytes_},
                    {"first_s", to_seconds(first_)},
                    {"last_s", to_seconds(last_)},
                    {"duration_s", to_seconds(duration)},
                    {"rate_hz", rate(packets_, duration)}};
  json["interval_ms"] = {{"median", to_milliseconds(median)},
                         {"p99", to_milliseconds(intervals_.percentile(0.99))},
                         {"max", to_milliseconds(intervals_.max())}};
  json["gaps_over_5_medians"] = median > Duration::zero() ? gaps(5 * median) : 0;
  json["truncated"] = truncated_;
  json["backwards_in_time"] = backwards_;
  json["missing_sequence_numbers"] = missing_;
  for (const auto& [number, channel] : channels_) {
    report::Json sizes = report::Json::object();
    for (const auto& [size, n] : channel.sizes) sizes[std::to_string(size)] = n;
    if (channel.other_sizes > 0) sizes["other"] = channel.other_sizes;
    json["channels"][std::to_string(number)] = {
        {"packets", channel.packets}, {"rate_hz", rate(channel.packets, duration)}, {"sizes", sizes}};
  }
  return json;
}

}  // namespace cairn::cli
