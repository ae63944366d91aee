// SPDX-License-Identifier: Apache-2.0
#include "drivers/thermal/config.hpp"

#include "drivers/thermal/models.hpp"

namespace cairn::thermal {
namespace {

std::vector<std::string> model_options() {
  std::vector<std::string> options;
  for (const Model& m : models()) options.emplace_back(m.name);
  return options;
}

}  // namespace

void declare(config::Section& s, Config& c) {
  s.group("capture", c.capture, "what the device is asked for");
  s.choice("model", c.model, model_options(),
           "sensor model, kept in the recording for cairn inspect; plain: any 16-bit camera without telemetry");
  s.choice("units", c.units, {"auto", "counts", "centikelvin", "decikelvin", "optris"},
           "what a count is; auto: what the telemetry says, counts without it; optris: only frames that Optris's own "
           "library calibrated");
  s.numbers("stretch_percent", c.stretch_percent, {0, 100}, "%",
            "two percentiles: in the 8-bit picture, pixels below the first are black, above the second white");
  s.number("min_span_c", c.min_span_c, {0.01, 1000}, "°C", "the 8-bit picture spans at least so much");
  s.number("min_span_counts", c.min_span_counts, {1, 65535}, "", "the same for frames in counts");
  s.number("latency_ms", c.latency_ms, {0, 1000}, "ms",
           "from the exposure to the frame's stamp; subtracted by the decoder");
}

Result<void> check(const Config& c) {
  std::string faults;
  const auto fault = [&](const std::string& text) { faults += (faults.empty() ? "" : "\n") + text; };
  if (auto capture = camera::check(c.capture); !capture) fault(capture.error().detail);
  if (find_model(c.model) == nullptr) fault("model: \"" + c.model + "\" is unknown");
  if (c.capture.format != "Y16") fault("format: only Y16 holds measurements, the others are pictures for people");
  if (c.stretch_percent.size() != 2 || !(c.stretch_percent[0] < c.stretch_percent[1]))
    fault("stretch_percent takes two numbers, the smaller first");
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the configuration of a thermal camera", {}, {}, faults};
}

}  // namespace cairn::thermal
