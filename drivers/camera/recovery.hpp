// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/time.hpp"

namespace cairn::camera {

/// Decides how a capture recovers from trouble, and when. Pure: the caller reports what happened and carries out the
/// step.
///
/// A silent or broken stream is restarted. After kMaxRestarts without a frame, or when the device is gone, the device
/// is closed and opened again after 0.1, 0.2, 0.4 … 2 s. Only a good frame resets these counts.
class Recovery {
 public:
  enum class Step { kRead, kRestart, kReopen, kWait };

  static constexpr int kMaxRestarts = 3;
  static constexpr Duration kFirstDelay = std::chrono::milliseconds(100);
  static constexpr Duration kMaxDelay = std::chrono::seconds(2);

  /// Starts as streaming. `silence` without a frame counts as a broken stream.
  Recovery(Time now, Duration silence);

  /// What to do at `now`.
  [[nodiscard]] Step step(Time now) const;
  /// Until then the step stays the same, unless something happens.
  [[nodiscard]] Time wake() const { return at_; }

  void frame(Time now);      ///< a good frame came
  void broken(Time now);     ///< the stream does not go on (EIO and the like)
  void lost(Time now);       ///< the device is gone and closed, or a restart or reopening failed
  void restarted(Time now);  ///< Step::kRestart was carried out
  void reopened(Time now);   ///< Step::kReopen was carried out

 private:
  enum class State { kStreaming, kBroken, kLost };
  void stream(Time now);

  Duration silence_;
  State state_ = State::kStreaming;
  Time at_;  // streaming: when it is silent; lost: when to open again
  int restarts_ = 0;
  Duration delay_ = kFirstDelay;
};

}  // namespace cairn::camera
