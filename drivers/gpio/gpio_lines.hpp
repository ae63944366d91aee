// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "drivers/gpio/config.hpp"
#include "drivers/gpio/line_event.hpp"
#include "hal/clock.hpp"
#include "hal/ports.hpp"
#include "hal/spsc_queue.hpp"

namespace cairn::gpio {

/// The lines of a Config: on a real chip, through libgpiod 1 or 2 (libgpiod1_lines.cpp, libgpiod2_lines.cpp), or files
/// (FileLines). next() gives the edges of the inputs in the order of their stamps, as far as they are known. Levels are
/// logical: true is active.
class GpioLines : public Source {
 public:
  /// Edges that were read.
  struct Counters {
    std::uint64_t events = 0, unstamped = 0;
  };
  /// Reads an input's level now. Errors: kNotFound (not configured), kIo (the chip is gone; open it again). The safety
  /// task calls this, set() and next() in every tick: an error allocates nothing, as line_lost() makes it.
  virtual Result<bool> level(Line line) = 0;
  /// Sets an output. Errors as level().
  virtual Result<void> set(Line line, bool level) = 0;
  /// set(), and next() gives the edge as it gives those of inputs, so that it is recorded.
  Result<void> pulse(Line line, bool level);
  [[nodiscard]] const Counters& counters() const { return counters_; }

 protected:
  GpioLines() = default;
  /// `clock` must outlive it.
  GpioLines(SourceId source, const Clock& clock) : source_(source), clock_(&clock) {}
  /// The oldest edge of pulse() that next() has not given. To be asked first.
  bool take_pulse(Packet& packet);
  /// Fills the packet of an edge.
  void fill(Packet& packet, const LineEvent& event, Time at);

  Counters counters_;

 private:
  struct Edge {
    LineEvent event;
    Time at{};
  };
  SourceId source_{};
  const Clock* clock_ = nullptr;  // null: pulses are not told
  SpscQueue<Edge> pulsed_{8};     // more than come between two calls of next()
};

/// Opens the configured lines for this program alone. `clock` must outlive them. Errors: kInvalidConfig, kNotFound
/// (chip or line), kIo (another program uses a line, or no permission), each with the remedy.
[[nodiscard]] Result<std::unique_ptr<GpioLines>> open_lines(const Config& config, SourceId source, const Clock& clock);

/// The same for a chip of the kernel; open_lines() has checked the config.
[[nodiscard]] Result<std::unique_ptr<GpioLines>> open_chip_lines(const Config& config, SourceId source,
                                                                 const Clock& clock);

/// How one line is used; for both versions of libgpiod.
struct LineUse {
  Line line{};
  std::string_view name;  ///< in the Config
  bool output = false, active_low = false;
  std::string_view bias = "as-is";
};
/// The configured lines, by Line. A line that is not used has an empty name.
[[nodiscard]] std::array<LineUse, kLines> uses_of(const Config& config);
/// The kernel's stamp as a Time. If it cannot be monotonic time (kernels before 5.7 use the time of day), `now` is
/// taken and `unstamped` is counted.
[[nodiscard]] Time plausible_stamp(std::int64_t ns, Time now, std::uint64_t& unstamped);
/// An Error for a line that is in use, for the present errno. It allocates nothing.
[[nodiscard]] Error line_lost(std::string_view cause, Line line);
/// The Error for a line that is not used. It allocates nothing.
[[nodiscard]] Error line_unused(Line line);
/// An Error for the line while it is opened, with the remedy for the present errno.
[[nodiscard]] Error line_error(std::string_view cause, const Config& config, std::string_view line);

}  // namespace cairn::gpio
