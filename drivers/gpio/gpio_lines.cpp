// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/gpio_lines.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#include "drivers/gpio/file_lines.hpp"

namespace cairn::gpio {

Result<std::unique_ptr<GpioLines>> open_lines(const Config& config, SourceId source, const Clock& clock) {
  if (auto sound = check(config); !sound) return sound.error();
  if (!is_file_chip(config.chip)) return open_chip_lines(config, source, clock);
  auto lines = FileLines::open(config, source, clock);
  if (!lines) return lines.error();
  return std::unique_ptr<GpioLines>(std::move(*lines));
}

std::array<LineUse, kLines> uses_of(const Config& c) {
  return {LineUse{Line::kEStop, c.estop_line, false, c.estop_active_low, c.estop_bias},
          LineUse{Line::kTrigger, c.trigger_line, true, false, "as-is"},
          LineUse{Line::kPps, c.pps_line, false, false, "as-is"}};
}

Time plausible_stamp(std::int64_t ns, Time now, std::uint64_t& unstamped) {
  constexpr Duration kFuture = std::chrono::milliseconds(1), kPast = std::chrono::seconds(10);
  const Time stamp{Duration{ns}};
  if (stamp <= now + kFuture && stamp >= now - kPast) return stamp;
  ++unstamped;
  return now;
}

Error line_lost(std::string_view cause, Line line) {
  const bool missing = errno == ENOENT || errno == ENOTDIR || errno == ENODEV;
  return {missing ? Errc::kNotFound : Errc::kIo, cause, std::string(name_of(line)), {}, {}};
}

Error line_unused(Line line) {
  return {Errc::kNotFound, "the GPIO line is not configured", std::string(name_of(line)), {}, {}};
}

Error line_error(std::string_view cause, const Config& config, std::string_view line) {
  const int why = errno;
  std::string where = config.chip;
  if (!line.empty()) where.append(", line ").append(line);
  std::string detail = std::strerror(why);
  if (why == EBUSY) detail += "; another program holds the line: gpioinfo shows which";
  if (why == EACCES || why == EPERM) detail += "; add the user to the group gpio, see config/udev";
  if (why == ENOENT || why == ENODEV) detail += "; gpiodetect and gpioinfo show what there is";
  const bool missing = why == ENOENT || why == ENODEV;
  return {missing ? Errc::kNotFound : Errc::kIo, cause, std::move(where), {}, std::move(detail)};
}

Result<void> GpioLines::pulse(Line line, bool level) {
  if (auto done = set(line, level); !done) return done;
  if (Edge* edge = clock_ != nullptr ? pulsed_.back() : nullptr) {
    *edge = {{.line = line, .level = level}, clock_->now()};
    pulsed_.push();
  }
  return {};
}

bool GpioLines::take_pulse(Packet& packet) {
  const Edge* edge = pulsed_.front();
  if (edge == nullptr) return false;
  fill(packet, edge->event, edge->at);
  pulsed_.pop();
  return true;
}

void GpioLines::fill(Packet& packet, const LineEvent& event, Time at) {
  encode_event(event, packet);
  packet.source = source_;
  packet.sequence = counters_.events++;
  packet.truncated = false;
  packet.arrival = at;
}

}  // namespace cairn::gpio
