// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/label/network_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace cairn::cli {
namespace {

/// The mean of `total` over `count`; 0 for none.
double mean_ms(Duration total, std::uint64_t count) {
  return count == 0 ? 0 : to_milliseconds(total) / static_cast<double>(count);
}

std::string_view name_of(std::size_t index) {
  return index < kSemanticClasses.size() ? kSemanticClasses[index].name : std::string_view("none");
}

}  // namespace

void NetworkFigures::add_time(Duration wall, Duration cpu) {
  wall_ += wall;
  cpu_ += cpu;
  longest_ = std::max(longest_, wall);
}

void NetworkFigures::add(const LabelImage& labels) {
  labels_ = true;
  ++pictures_;
  pixels_ += labels.classes.size();
  for (const std::uint8_t id : labels.classes) ++of_class_[std::min<std::size_t>(id, kClasses)];
  for (const std::uint8_t p : labels.probabilities) probability_sum_ += p;
}

void NetworkFigures::add(const Detections& detections) {
  ++pictures_;
  for (const Detection& d : detections.found) ++of_class_[std::min<std::size_t>(d.class_id, kClasses)];
}

report::Json NetworkFigures::to_json() const {
  report::Json json{{"model", facts.file.string()},
                    {"sha256", facts.sha256},
                    {"checked", facts.checked},
                    {"opset", facts.opset},
                    {"input", std::to_string(facts.input_width) + "x" + std::to_string(facts.input_height)},
                    {"output", facts.output},
                    {"pictures", pictures_},
                    {"failed", failed},
                    {"mean_ms", mean_ms(wall_, pictures_)},
                    {"max_ms", to_milliseconds(longest_)},
                    {"mean_cpu_ms", mean_ms(cpu_, pictures_)}};
  report::Json classes = report::Json::object();
  for (std::size_t i = 0; i < of_class_.size(); ++i) {
    if (of_class_[i] == 0) continue;
    if (labels_)
      classes[std::string(name_of(i))] = static_cast<double>(of_class_[i]) / static_cast<double>(pixels_);
    else
      classes[std::string(name_of(i))] = of_class_[i];
  }
  json[labels_ ? "share" : "boxes"] = std::move(classes);
  if (labels_) json["mean_probability"] = static_cast<double>(probability_sum_) / 255.0 / static_cast<double>(pixels_);
  return json;
}

std::string NetworkFigures::to_text(const std::string& what) const {
  std::string text = fmt::format("{}: {} pictures, {:.1f} ms each (CPU {:.1f} ms, longest {:.1f} ms)", what, pictures_,
                                 mean_ms(wall_, pictures_), mean_ms(cpu_, pictures_), to_milliseconds(longest_));
  if (failed > 0) text += fmt::format(", {} without an answer", failed);
  text += fmt::format("\n  {}, {}x{}, output {}\n ", facts.file.string(), facts.input_width, facts.input_height,
                      facts.output);
  for (std::size_t i = 0; i < of_class_.size(); ++i) {
    if (of_class_[i] == 0) continue;
    if (labels_)
      text += fmt::format(" {} {:.1f} %,", name_of(i),
                          100 * static_cast<double>(of_class_[i]) / static_cast<double>(pixels_));
    else
      text += fmt::format(" {} {},", of_class_[i], name_of(i));
  }
  if (text.back() != ',') return text + " nothing found\n";
  text.back() = '\n';
  return text;
}

}  // namespace cairn::cli
