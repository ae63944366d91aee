// SPDX-License-Identifier: Apache-2.0
// Any frames at any time, as any program on the bus of `cairn simulate --live` may send them: the simulated motor
// controller keeps a finite wheel, answers with sound frames, and turns a wheel only while it is enabled.
#include <cmath>

#include "tests/fuzz/require.hpp"
#include "tools/simulator/motion/drive_model.hpp"

namespace {

using namespace cairn;
using namespace cairn::drive;

void step(simulator::DriveModel& model, Time now, simulator::DriveModel::Frames& out) {
  const bool enabled = model.state() == cia402::State::kOperationEnabled;
  const double before = std::abs(model.speed());
  model.step(now, out);
  require(enabled || std::abs(model.speed()) <= before);
}

void check(const simulator::DriveModel& model, const simulator::DriveModel::Frames& out) {
  require(std::isfinite(model.angle()) && std::isfinite(model.speed()));
  for (const CanFrame& frame : out) {
    Packet packet;
    encode_frame(frame, packet);
    const auto again = decode_frame(packet.payload());
    require(again && *again == frame);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  simulator::DriveModel model({});
  simulator::DriveModel::Frames out;
  Time now{std::chrono::seconds(1)};
  model.power_on(now, out);
  // Records: milliseconds to wait, struct can_frame.
  constexpr std::size_t kRecord = 1 + kClassicBytes;
  for (std::size_t at = 0; at + kRecord <= size; at += kRecord) {
    out.clear();
    step(model, now += std::chrono::milliseconds(data[at]), out);
    const auto frame = decode_frame(std::as_bytes(std::span(data + at + 1, kClassicBytes)));
    if (frame) model.receive(*frame, now, out);
    check(model, out);
  }
  return 0;
}
