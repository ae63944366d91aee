// SPDX-License-Identifier: Apache-2.0
// GPIO lines through libgpiod 2.x: all in one request, with the kernel's sequence numbers.
#include <gpiod.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <string>

#include "drivers/gpio/gpio_lines.hpp"

namespace cairn::gpio {
namespace {

template <auto Free>
struct Freed {
  template <class T>
  void operator()(T* object) const {
    Free(object);
  }
};
using Chip = std::unique_ptr<gpiod_chip, Freed<gpiod_chip_close>>;
using Settings = std::unique_ptr<gpiod_line_settings, Freed<gpiod_line_settings_free>>;
using LineConfig = std::unique_ptr<gpiod_line_config, Freed<gpiod_line_config_free>>;
using RequestConfig = std::unique_ptr<gpiod_request_config, Freed<gpiod_request_config_free>>;
using Request = std::unique_ptr<gpiod_line_request, Freed<gpiod_line_request_release>>;
using Buffer = std::unique_ptr<gpiod_edge_event_buffer, Freed<gpiod_edge_event_buffer_free>>;

bool has_label(gpiod_chip* chip, const std::string& label) {
  const std::unique_ptr<gpiod_chip_info, Freed<gpiod_chip_info_free>> info(gpiod_chip_get_info(chip));
  return info && label == gpiod_chip_info_get_label(info.get());
}

/// 2.x opens paths alone; name, number and label are looked up here.
Chip open_chip(const std::string& chip) {
  for (const std::string& path : {chip, "/dev/" + chip, "/dev/gpiochip" + chip})
    if (gpiod_is_gpiochip_device(path.c_str())) return Chip(gpiod_chip_open(path.c_str()));
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", none)) {
    if (!entry.path().filename().string().starts_with("gpiochip")) continue;
    Chip found(gpiod_chip_open(entry.path().c_str()));
    if (found && has_label(found.get(), chip)) return found;
  }
  errno = ENOENT;
  return nullptr;
}

int offset_of(gpiod_chip* chip, std::string_view name) {
  int number = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error == std::errc{} && end == name.data() + name.size()) return number;
  return gpiod_chip_get_line_offset_from_name(chip, std::string(name).c_str());
}

gpiod_line_bias bias_of(std::string_view bias) {
  if (bias == "disabled") return GPIOD_LINE_BIAS_DISABLED;
  if (bias == "pull-up") return GPIOD_LINE_BIAS_PULL_UP;
  return bias == "pull-down" ? GPIOD_LINE_BIAS_PULL_DOWN : GPIOD_LINE_BIAS_AS_IS;
}

Settings settings_of(const LineUse& use) {
  Settings settings(gpiod_line_settings_new());
  if (!settings) return settings;
  gpiod_line_settings_set_direction(settings.get(),
                                    use.output ? GPIOD_LINE_DIRECTION_OUTPUT : GPIOD_LINE_DIRECTION_INPUT);
  if (!use.output) gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_BOTH);
  gpiod_line_settings_set_bias(settings.get(), bias_of(use.bias));
  gpiod_line_settings_set_active_low(settings.get(), use.active_low);
  gpiod_line_settings_set_event_clock(settings.get(), GPIOD_LINE_CLOCK_MONOTONIC);
  return settings;
}

class Libgpiod2Lines final : public GpioLines {
 public:
  static constexpr std::size_t kKernelEvents = 256;

  Libgpiod2Lines(Config config, Chip chip, SourceId source, const Clock& clock)
      : GpioLines(source, clock), config_(std::move(config)), chip_(std::move(chip)), clock_(clock) {
    offsets_.fill(-1);
  }

  Result<void> request() {
    LineConfig lines(gpiod_line_config_new());
    RequestConfig request(gpiod_request_config_new());
    buffer_.reset(gpiod_edge_event_buffer_new(1));
    if (!lines || !request || !buffer_) return line_error("out of memory", config_, {});
    gpiod_request_config_set_consumer(request.get(), "cairn");
    gpiod_request_config_set_event_buffer_size(request.get(), kKernelEvents);
    bool any = false;
    for (const LineUse& use : uses_of(config_)) {
      if (use.name.empty()) continue;
      const int offset = offset_of(chip_.get(), use.name);
      if (offset < 0) return line_error("no such GPIO line", config_, use.name);
      const Settings settings = settings_of(use);
      const auto number = static_cast<unsigned>(offset);
      if (!settings || gpiod_line_config_add_line_settings(lines.get(), &number, 1, settings.get()) != 0)
        return line_error("cannot set up the GPIO line", config_, use.name);
      offsets_[static_cast<std::size_t>(use.line)] = offset;
      any = true;
    }
    if (!any) return {};
    request_.reset(gpiod_chip_request_lines(chip_.get(), request.get(), lines.get()));
    if (!request_) return line_error("cannot request the GPIO lines", config_, {});
    return {};
  }

  Result<Poll> next(Packet& packet, Duration timeout) override {
    if (take_pulse(packet)) return Poll::kPacket;
    if (!request_) return Poll::kTimeout;
    const int ready = gpiod_line_request_wait_edge_events(request_.get(), std::max<std::int64_t>(0, timeout.count()));
    if (ready < 0 && errno != EINTR) return Error{Errc::kIo, "cannot wait for events of the GPIO lines", {}, {}, {}};
    if (ready <= 0) return Poll::kTimeout;
    if (gpiod_line_request_read_edge_events(request_.get(), buffer_.get(), 1) != 1)
      return Error{Errc::kIo, "cannot read an event of the GPIO lines", {}, {}, {}};
    gpiod_edge_event* event = gpiod_edge_event_buffer_get_event(buffer_.get(), 0);
    const auto offset = static_cast<int>(gpiod_edge_event_get_line_offset(event));
    const auto line = static_cast<std::size_t>(std::find(offsets_.begin(), offsets_.end(), offset) - offsets_.begin());
    if (line == kLines) return Poll::kTimeout;
    const bool rising = gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE;
    const auto sequence = static_cast<std::uint32_t>(gpiod_edge_event_get_line_seqno(event));
    const auto stamp = static_cast<std::int64_t>(gpiod_edge_event_get_timestamp_ns(event));
    fill(packet, {static_cast<Line>(line), rising, false, sequence},
         plausible_stamp(stamp, clock_.now(), counters_.unstamped));
    return Poll::kPacket;
  }

  Result<bool> level(Line line) override {
    const int offset = offsets_[static_cast<std::size_t>(line)];
    if (offset < 0) return line_unused(line);
    const auto value = gpiod_line_request_get_value(request_.get(), static_cast<unsigned>(offset));
    if (value == GPIOD_LINE_VALUE_ERROR) return line_lost("cannot read the GPIO line", line);
    return value == GPIOD_LINE_VALUE_ACTIVE;
  }

  Result<void> set(Line line, bool level) override {
    const int offset = offsets_[static_cast<std::size_t>(line)];
    if (offset < 0) return line_unused(line);
    const auto value = level ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    if (gpiod_line_request_set_value(request_.get(), static_cast<unsigned>(offset), value) != 0)
      return line_lost("cannot set the GPIO line", line);
    return {};
  }

 private:
  Config config_;
  Chip chip_;
  Request request_;
  Buffer buffer_;
  const Clock& clock_;
  std::array<int, kLines> offsets_{};  // on the chip; −1: not configured
};

}  // namespace

Result<std::unique_ptr<GpioLines>> open_chip_lines(const Config& config, SourceId source, const Clock& clock) {
  Chip chip = open_chip(config.chip);
  if (!chip) return line_error("cannot open the GPIO chip", config, {});
  auto made = std::make_unique<Libgpiod2Lines>(config, std::move(chip), source, clock);
  if (auto requested = made->request(); !requested) return requested.error();
  return std::unique_ptr<GpioLines>(std::move(made));
}

}  // namespace cairn::gpio
