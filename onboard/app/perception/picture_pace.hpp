// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "hal/packet.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// Chooses the pictures that are looked at, from a port whose values have a Packet `packet`: of those that have come
/// the newest, and not more than one in a period on the average.
class PicturePace {
 public:
  explicit PicturePace(Duration period) : period_(period) {}

  /// Null: none is to be looked at in this tick. The picture is valid until the next call. `passed` counts the others.
  template <class Picture>
  const Packet* take_newest(scheduler::InputPort<Picture>& pictures, scheduler::Tick& tick, RelaxedCounter& passed) {
    bool any = false;
    while (Picture* picture = pictures.take(tick)) {
      const Time arrival = picture->packet.arrival;
      const bool early = arrival < due_ && arrival >= due_ - period_;
      if (early || std::exchange(any, true)) ++passed;
      if (!early) std::swap(newest_, picture->packet);
    }
    if (!any) return nullptr;
    const bool on_time = newest_.arrival >= due_ && newest_.arrival - due_ < period_;
    due_ = on_time ? due_ + period_ : newest_.arrival + period_;
    return &newest_;
  }

 private:
  Duration period_;
  Packet newest_;
  Time due_{};  // a picture that arrives from then on is looked at
};

}  // namespace cairn::app
