// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/thermal_stream.hpp"

#include <utility>

namespace cairn::app {

ThermalStream::ThermalStream(thermal::Thermal camera, labelling::ThermalLifter lifter, Monitor& monitor)
    : camera_(std::move(camera)), joiner_(std::move(lifter)), monitor_(monitor) {}

void ThermalStream::add(const LocatedScan& scan) {
  if (!scan.lost) joiner_.add_scan(scan.stamp, scan.T_odom_base.mean, scan.twist, scan.epoch, scan.points_base);
}

void ThermalStream::add(const Packet& picture) {
  const auto frame = camera_.decode(picture);
  if (!frame) return monitor_.event(picture.arrival, "clients", "no thermal cloud: " + to_string(frame.error()));
  if (*frame != nullptr && !(*frame)->correcting) joiner_.add_picture((*frame)->values);
}

/// A cloud that finds no room waits for the next tick.
void ThermalStream::serve(ClientHub& hub, std::size_t records) {
  while (labelling::ThermalCloud* out = clouds_.back()) {
    const auto made = joiner_.next(*out);
    if (!made) monitor_.event(out->stamp, "clients", "no thermal cloud: " + to_string(made.error()));
    if (made && !*made) break;
    if (made) clouds_.push();
  }
  stream_.serve(hub, clouds_, records, [](const labelling::ThermalCloud&) {});
}

}  // namespace cairn::app
