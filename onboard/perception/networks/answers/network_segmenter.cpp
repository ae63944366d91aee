// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/answers/network_segmenter.hpp"

#include <string>
#include <utility>

#include "onboard/perception/networks/answers/labels_of_logits.hpp"
#include "onboard/perception/networks/model/onnx_header.hpp"

namespace cairn::networks {

Result<std::unique_ptr<NetworkSegmenter>> NetworkSegmenter::create(Network network, const NetworkConfig& config) {
  auto classes = ClassMap::parse(config.classes);
  if (!classes) return classes.error();
  const auto refuse = [&](const std::string& remedy) {
    const NetworkFacts& facts = network.facts();
    return Error{Errc::kInvalidConfig,
                 "the model's output is not of the family logits",
                 facts.file.string(),
                 {},
                 "expected 1x" + classes->size_text() + "xheightxwidth, found " + facts.output + "; " + remedy};
  };
  if (network.outputs().size() != 1) return refuse("export the model with the class planes as its only output");
  const auto& shape = network.outputs().front().shape;
  if (shape.size() != 4 || shape[0] != 1) return refuse("export the model without argmax and with one picture a run");
  if (!classes->fits(static_cast<std::size_t>(shape[1]))) return refuse("set `classes` to what the model's planes are");
  const NetworkFacts& facts = network.facts();
  if (shape[2] < 1 || shape[3] < 1 || shape[2] > facts.input_height || shape[3] > facts.input_width)
    return refuse("its planes are at most as large as its input");
  return std::unique_ptr<NetworkSegmenter>(new NetworkSegmenter(std::move(network), std::move(*classes)));
}

Result<const LabelImage*> NetworkSegmenter::segment(const Image& picture) {
  if (auto run = network_.run(picture.view()); !run) return run.error();
  const Output& output = network_.outputs().front();
  labels_.source = picture.source;
  labels_.stamp = picture.stamp;
  labels_.resize(static_cast<int>(output.shape[3]), static_cast<int>(output.shape[2]));
  labels_of_logits(output.values, static_cast<std::size_t>(output.shape[1]), classes_, labels_);
  return &labels_;
}

}  // namespace cairn::networks
