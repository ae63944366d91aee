// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/config.hpp"

#include "drivers/camera/frame.hpp"

namespace cairn::camera {
namespace {

std::vector<std::string> format_options() {
  std::vector<std::string> options;
  for (const FormatInfo& f : formats())
    if (f.format != FrameFormat::kPng) options.emplace_back(f.name);
  return options;
}

std::string faults_of(const CaptureConfig& c) {
  std::string faults;
  const FormatInfo* info = find_format(std::string_view(c.format));
  if (info == nullptr) {
    faults = "format: \"" + c.format + "\" is not one that is decoded";
  } else if (static_cast<unsigned>(c.width) % info->even != 0) {
    faults = "width: " + c.format + " needs an even number";
  } else if (info->half_plane && static_cast<unsigned>(c.height) % info->even != 0) {
    faults = "height: " + c.format + " needs an even number";
  }
  if (!c.device.empty() && !c.device.starts_with('/'))
    faults += (faults.empty() ? "" : "\n") + ("device: \"" + c.device + "\" is no path such as /dev/v4l/by-id/…");
  return faults;
}

Result<void> verdict(const std::string& faults) {
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the configuration of a camera", {}, {}, faults};
}

}  // namespace

void declare(config::Section& s, CaptureConfig& c) {
  s.text("device", c.device, "path of the device, best of /dev/v4l/by-id: its numbers change; empty: replay only");
  s.choice("format", c.format, format_options(), "pixel format, as v4l2-ctl --list-formats-ext names it");
  s.integer("width", c.width, {1, kMaxSide}, "px", "of the whole frame: both eyes, telemetry rows and all");
  s.integer("height", c.height, {1, kMaxSide}, "px", "of the whole frame");
  s.number("rate_hz", c.rate_hz, {0.1, 1000}, "1/s", "frames; the device may grant another rate");
  s.flag("triggered", c.triggered, "gpio.trigger_line exposes it: pictures have the time of their pulse");
  s.integer("buffers", c.buffers, {2, 32}, "", "frames that the kernel may fill before one is taken");
}

void declare(config::Section& s, Config& c) {
  s.group("capture", c.capture, "what the device is asked for");
  s.flag("side_by_side", c.side_by_side,
         "two pictures in one frame; the left half is the left eye's, which is looked at");
  s.number("latency_ms", c.latency_ms, {0, 1000}, "ms",
           "from the exposure to the frame's stamp; subtracted by the decoder");
}

Result<void> check(const CaptureConfig& config) { return verdict(faults_of(config)); }

Result<void> check(const Config& config) {
  std::string faults = faults_of(config.capture);
  if (config.side_by_side && config.capture.width % 2 != 0)
    faults += (faults.empty() ? "" : "\n") + std::string("width: side_by_side needs an even number");
  return verdict(faults);
}

}  // namespace cairn::camera
