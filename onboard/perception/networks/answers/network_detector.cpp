// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/answers/network_detector.hpp"

#include <string>
#include <utility>

namespace cairn::networks {
namespace {

/// The last two sizes of a shape whose others are 1: a table. None: it is no table.
struct Table {
  std::size_t rows = 0, columns = 0;
};
Table table_of(const Output& output) {
  const auto& shape = output.shape;
  if (shape.size() < 2) return {};
  for (std::size_t i = 0; i + 2 < shape.size(); ++i)
    if (shape[i] != 1) return {};
  return {static_cast<std::size_t>(shape[shape.size() - 2]), static_cast<std::size_t>(shape.back())};
}

}  // namespace

Error NetworkDetector::unfit(const std::string& expected, const std::string& remedy) const {
  const NetworkFacts& facts = network_.facts();
  return {Errc::kInvalidConfig,
          "the model's output is not of the family that the profile says",
          facts.file.string(),
          {},
          "expected " + expected + ", found " + facts.output + "; " + remedy};
}

Result<void> NetworkDetector::expect_yolox() {
  constexpr std::size_t kBox = 5;
  const NetworkFacts& facts = network_.facts();
  const std::size_t rows = yolox_rows(facts.input_width, facts.input_height, strides_);
  const std::string expected = "1x" + std::to_string(rows) + "x(5 + " + classes_.size_text() + ") for a " +
                               std::to_string(facts.input_width) + "x" + std::to_string(facts.input_height) + " input";
  if (network_.outputs().size() != 1) return unfit(expected, "export the model with one output");
  const Table table = table_of(network_.outputs().front());
  if (table.rows != rows) return unfit(expected, "set `strides` and the input's size to the model's");
  if (table.columns <= kBox || !classes_.fits(table.columns - kBox))
    return unfit(expected, "set `classes` to what the model's last columns are");
  form_ = Form::kYolox;
  return {};
}

Result<void> NetworkDetector::expect_ssd() {
  constexpr std::size_t kColumns = 7;
  const std::string expected =
      "one output 1x1xNx7, or two outputs 1xNx4 (boxes) and 1xNx" + classes_.size_text() + " (scores)";
  const auto outputs = network_.outputs();
  if (outputs.size() == 1) {
    form_ = Form::kSsdRows;
    return table_of(outputs[0]).columns == kColumns ? Result<void>{} : unfit(expected, "set `family` to the model's");
  }
  if (outputs.size() != 2) return unfit(expected, "export the model with these outputs");
  form_ = Form::kSsdPair;
  const Table first = table_of(outputs[0]), second = table_of(outputs[1]);
  if (first.rows != second.rows || (first.columns == 4) == (second.columns == 4))
    return unfit(expected, "boxes have 4 columns, scores have another number of them");
  scores_ = first.columns == 4 ? 1 : 0;
  const std::size_t columns = scores_ == 0 ? first.columns : second.columns;
  if (columns < 2 || !classes_.fits(columns))
    return unfit(expected, "set `classes` to the model's, the background (none) first");
  return {};
}

Result<std::unique_ptr<NetworkDetector>> NetworkDetector::create(Network network, const NetworkConfig& config) {
  auto classes = ClassMap::parse(config.classes);
  if (!classes) return classes.error();
  auto strides = parse_strides(config.strides);
  if (!strides) return strides.error();
  const BoxRules rules{static_cast<float>(config.score_threshold), static_cast<float>(config.nms_threshold)};
  std::unique_ptr<NetworkDetector> detector(
      new NetworkDetector(std::move(network), std::move(*classes), std::move(*strides), rules));
  auto fits = config.family == "yolox" ? detector->expect_yolox() : detector->expect_ssd();
  if (!fits) return fits.error();
  return detector;
}

void NetworkDetector::read() {
  const NetworkFacts& facts = network_.facts();
  const auto outputs = network_.outputs();
  candidates_.clear();
  const float threshold = rules_.score_threshold;
  switch (form_) {
    case Form::kYolox:
      return read_yolox(outputs[0].values, table_of(outputs[0]).columns, facts.input_width, facts.input_height,
                        strides_, threshold, candidates_);
    case Form::kSsdRows:
      return read_ssd_rows(outputs[0].values, facts.input_width, facts.input_height, threshold, candidates_);
    case Form::kSsdPair:
      return read_ssd_pair(outputs[scores_].values, table_of(outputs[scores_]).columns, outputs[1 - scores_].values,
                           facts.input_width, facts.input_height, threshold, candidates_);
  }
}

Result<const Detections*> NetworkDetector::detect(const Image& picture) {
  if (auto run = network_.run(picture.view()); !run) return run.error();
  read();
  detections_.source = picture.source;
  detections_.stamp = picture.stamp;
  detections_.width = picture.width;
  detections_.height = picture.height;
  select_boxes(candidates_, classes_, rules_, network_.placement(), detections_.found);
  return &detections_;
}

}  // namespace cairn::networks
