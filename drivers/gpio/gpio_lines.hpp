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

namespace cairn::gpio {

/// The lines of a Config on a real chip, through libgpiod: libgpiod1_lines.cpp or libgpiod2_lines.cpp, as installed.
/// next() gives edges of the inputs in the order of their stamps as far as they are known. Levels are logical: active
/// is true.
class GpioLines : public Source {
 public:
  struct Counters {
    std::uint64_t events = 0, unstamped = 0;
  };
  /// Reads an input's level now. Errors: kNotFound (not configured), kIo (the chip is gone; open it again).
  virtual Result<bool> level(Line line) = 0;
  /// Sets an output.
  virtual Result<void> set(Line line, bool level) = 0;
  [[nodiscard]] const Counters& counters() const { return counters_; }

 protected:
  GpioLines() = default;
  Counters counters_;
};

/// Requests the configured lines for itself. `clock` must outlive them. Errors: kInvalidConfig, kNotFound (chip or
/// line), kIo (someone else uses a line, no permission), each with the remedy.
[[nodiscard]] Result<std::unique_ptr<GpioLines>> open_lines(const Config& config, SourceId source, const Clock& clock);

/// What both generations of libgpiod share.
struct LineUse {
  Line line{};
  std::string_view name;  ///< in the Config
  bool output = false, active_low = false;
  std::string_view bias = "as-is";
};
/// The configured lines; unused places have an empty name.
[[nodiscard]] std::array<LineUse, kLines> uses_of(const Config& config);
/// A kernel stamp on the monotonic line; `now` where it cannot be one (a kernel before 5.7 stamps with the wall clock).
[[nodiscard]] Time plausible_stamp(std::int64_t ns, Time now, std::uint64_t& unstamped);
/// With the remedy that fits errno.
[[nodiscard]] Error line_error(std::string_view cause, const Config& config, std::string_view line);

}  // namespace cairn::gpio
