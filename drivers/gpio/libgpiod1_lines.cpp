// SPDX-License-Identifier: Apache-2.0
// GPIO lines through libgpiod 1.x, whose events carry no sequence numbers: a lost edge shows only in the level.
#include <gpiod.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <string>

#include "drivers/gpio/gpio_lines.hpp"

namespace cairn::gpio {
namespace {

struct CloseChip {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }  // releases its lines, too
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

gpiod_line* find_line(gpiod_chip* chip, std::string_view name) {
  unsigned number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error == std::errc{} && end == name.data() + name.size()) return gpiod_chip_get_line(chip, number);
  errno = ENOENT;
  return gpiod_chip_find_line(chip, std::string(name).c_str());
}

int flags_of(const LineUse& use) {
  int flags = use.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  if (use.bias == "disabled") flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
  if (use.bias == "pull-up") flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
  if (use.bias == "pull-down") flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  return flags;
}

class Libgpiod1Lines final : public GpioLines {
 public:
  Libgpiod1Lines(Config config, Chip chip, SourceId source, const Clock& clock)
      : GpioLines(source, clock), config_(std::move(config)), chip_(std::move(chip)), clock_(clock) {}

  Result<void> request() {
    for (const LineUse& use : uses_of(config_)) {
      if (use.name.empty()) continue;
      gpiod_line* line = find_line(chip_.get(), use.name);
      if (line == nullptr) return line_error("no such GPIO line", config_, use.name);
      const int done = use.output ? gpiod_line_request_output_flags(line, "cairn", flags_of(use), 0)
                                  : gpiod_line_request_both_edges_events_flags(line, "cairn", flags_of(use));
      if (done != 0) return line_error("cannot request the GPIO line", config_, use.name);
      lines_[static_cast<std::size_t>(use.line)] = line;
      if (!use.output) inputs_[waits_] = use.line, waiting_[waits_++] = {gpiod_line_event_get_fd(line), POLLIN, 0};
    }
    return {};
  }

  Result<Poll> next(Packet& packet, Duration timeout) override {
    if (take_pulse(packet)) return Poll::kPacket;
    const auto ns = std::max<std::int64_t>(0, timeout.count());
    const timespec limit{ns / 1'000'000'000, ns % 1'000'000'000};
    if (ppoll(waiting_.data(), waits_, &limit, nullptr) <= 0) return Poll::kTimeout;
    for (std::size_t i = 0; i < waits_; ++i) {
      turn_ = (turn_ + 1) % waits_;  // so that a chattering line does not starve the others
      if (waiting_[turn_].revents != 0) return read(inputs_[turn_], packet);
    }
    return Poll::kTimeout;
  }

  Result<bool> level(Line line) override {
    gpiod_line* found = lines_[static_cast<std::size_t>(line)];
    if (found == nullptr) return line_unused(line);
    const int value = gpiod_line_get_value(found);
    if (value < 0) return line_lost("cannot read the GPIO line", line);
    return value != 0;
  }

  Result<void> set(Line line, bool level) override {
    gpiod_line* found = lines_[static_cast<std::size_t>(line)];
    if (found == nullptr) return line_unused(line);
    if (gpiod_line_set_value(found, level ? 1 : 0) != 0) return line_lost("cannot set the GPIO line", line);
    return {};
  }

 private:
  Result<Poll> read(Line line, Packet& packet) {
    gpiod_line_event event{};
    if (gpiod_line_event_read(lines_[static_cast<std::size_t>(line)], &event) != 0)
      return line_lost("cannot read an event of the GPIO line", line);
    fill(packet, {line, event.event_type == GPIOD_LINE_EVENT_RISING_EDGE, false, 0},
         plausible_stamp(event.ts.tv_sec * 1'000'000'000 + event.ts.tv_nsec, clock_.now(), counters_.unstamped));
    return Poll::kPacket;
  }

  Config config_;
  Chip chip_;
  const Clock& clock_;
  std::array<gpiod_line*, kLines> lines_{};
  std::array<pollfd, kLines> waiting_{};
  std::array<Line, kLines> inputs_{};
  std::size_t waits_ = 0, turn_ = 0;
};

}  // namespace

Result<std::unique_ptr<GpioLines>> open_chip_lines(const Config& config, SourceId source, const Clock& clock) {
  Chip chip(gpiod_chip_open_lookup(config.chip.c_str()));
  if (!chip) return line_error("cannot open the GPIO chip", config, {});
  auto made = std::make_unique<Libgpiod1Lines>(config, std::move(chip), source, clock);
  if (auto requested = made->request(); !requested) return requested.error();
  return std::unique_ptr<GpioLines>(std::move(made));
}

}  // namespace cairn::gpio
