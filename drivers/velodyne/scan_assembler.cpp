// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/scan_assembler.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "drivers/velodyne/trigonometry.hpp"

namespace cairn::velodyne {

ScanAssembler::ScanAssembler(const Options& options) : options_(options) {
  for (Scan* scan : {&running_, &finished_}) {
    scan->source = options.source;
    scan->cloud.reserve(options.reserve_points);
  }
}

void ScanAssembler::begin_firing(Time time, double azimuth_deg, Duration last_laser, Duration period) {
  const double since_cut_deg = wrap_360(azimuth_deg - options_.cut_angle_deg);
  if (firings_ > 0 && !finished_now_) {
    if (time - running_.valid.start > timeout(period)) {
      close(false);
    } else if (crosses_cut(time, since_cut_deg, period)) {
      close(true);
      last_cut_ = time;
    }
  }
  sweep(azimuth_deg);
  if (firings_++ == 0) running_.valid.start = time;
  running_.valid.end = time + last_laser;
  since_cut_deg_ = since_cut_deg;
}

/// Two firings in a row of an even turn are less than a degree apart; more is a gap, or a step back.
void ScanAssembler::sweep(double azimuth_deg) {
  constexpr double kMaxStep = 1.0;
  const double step = wrap_360(azimuth_deg - azimuth_deg_);
  if (firings_ > 0 && step < kMaxStep) swept_deg_ += step;
  azimuth_deg_ = azimuth_deg;
}

/// The angle since the cut falls back. Less than half a turn after the last cut that is the encoder's jitter.
bool ScanAssembler::crosses_cut(Time time, double since_cut_deg, Duration period) const {
  return since_cut_deg < since_cut_deg_ && !(last_cut_ && time - *last_cut_ < period / 2);
}

Duration ScanAssembler::timeout(Duration period) const {
  return from_seconds(to_seconds(period) * options_.timeout_turns);
}

void ScanAssembler::add_lost(std::uint64_t packets) {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint32_t>::max();
  running_.lost_packets = static_cast<std::uint32_t>(std::min(kMax, running_.lost_packets + std::min(kMax, packets)));
  incomplete_ = true;
}

void ScanAssembler::close(bool at_cut) {
  running_.incomplete = incomplete_ || !at_cut;
  running_.partial = running_.incomplete && swept_deg_ < options_.field_of_view_deg / 2;
  running_.time_quality = quality_;
  std::swap(running_, finished_);
  finished_now_ = true;
  revolutions_ += at_cut ? 1 : 0;
  running_.cloud.clear();
  running_.lost_packets = 0;
  firings_ = 0;
  swept_deg_ = 0;
  incomplete_ = !at_cut;
}

bool ScanAssembler::discard() {
  const bool had_one = firings_ > 0;
  running_.cloud.clear();
  running_.lost_packets = 0;
  firings_ = 0;
  swept_deg_ = 0;
  incomplete_ = true;
  last_cut_.reset();
  return had_one;
}

const Scan* ScanAssembler::expire(Time now, Duration period) {
  return firings_ > 0 && now - running_.valid.start > timeout(period) ? flush() : nullptr;
}

const Scan* ScanAssembler::flush() {
  if (firings_ == 0) return nullptr;
  close(false);
  return &finished_;
}

}  // namespace cairn::velodyne
