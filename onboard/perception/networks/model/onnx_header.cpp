// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/model/onnx_header.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "onboard/perception/networks/model/onnx_weights.hpp"
#include "onboard/perception/networks/model/proto_message.hpp"

namespace cairn::networks {
namespace {

constexpr std::size_t kMaxTensors = 64, kMaxDimensions = 8, kMaxName = 256;

// Field numbers of onnx.proto3.
constexpr std::uint32_t kModelProducer = 2, kModelGraph = 7, kModelOpset = 8;
constexpr std::uint32_t kGraphNode = 1, kGraphInitializer = 5, kGraphInput = 11, kGraphOutput = 12;
constexpr std::uint32_t kNodeAttribute = 5, kAttributeTensor = 5;
constexpr std::uint32_t kOpsetDomain = 1, kOpsetVersion = 2;
constexpr std::uint32_t kValueName = 1, kValueType = 2;
constexpr std::uint32_t kTypeTensor = 1, kTensorShape = 2, kShapeDimension = 1, kDimensionValue = 1;

std::string short_name(std::string_view name) { return std::string(name.substr(0, kMaxName)); }

bool parse_dimension(std::string_view bytes, OnnxTensor& tensor) {
  std::int64_t size = 0;
  if (!each_field(bytes, [&](const ProtoField& f) {
        if (f.number == kDimensionValue) size = static_cast<std::int64_t>(f.value);
        return true;
      }))
    return false;
  if (tensor.shape.size() == kMaxDimensions) return false;
  tensor.shape.push_back(std::max<std::int64_t>(size, 0));
  return true;
}

bool parse_value(std::string_view bytes, OnnxTensor& tensor) {
  const auto shape = [&](const ProtoField& f) {
    return f.number != kShapeDimension || parse_dimension(f.bytes, tensor);
  };
  const auto type = [&](const ProtoField& f) { return f.number != kTensorShape || each_field(f.bytes, shape); };
  return each_field(bytes, [&](const ProtoField& f) {
    if (f.number == kValueName) tensor.name = short_name(f.bytes);
    if (f.number != kValueType) return true;
    return each_field(f.bytes,
                      [&](const ProtoField& t) { return t.number != kTypeTensor || each_field(t.bytes, type); });
  });
}

struct Graph {
  std::vector<OnnxTensor> inputs, outputs;
  std::set<std::string_view> weights;  // files of old versions list them among the inputs
  bool external = false;               // some are in another file
  bool unfit = false;                  // some have another number of values than their shape says
};

bool parse_weights(std::string_view bytes, Graph& graph) {
  OnnxWeights weights;
  if (!parse_onnx_weights(bytes, weights)) return false;
  graph.weights.insert(weights.name);
  graph.external |= weights.external;
  graph.unfit |= !weights.external && !weights.complete();
  return true;
}

/// Constants of nodes are weights, too.
bool parse_node(std::string_view bytes, Graph& graph) {
  const auto attribute = [&](const ProtoField& f) {
    return f.number != kAttributeTensor || parse_weights(f.bytes, graph);
  };
  return each_field(bytes,
                    [&](const ProtoField& f) { return f.number != kNodeAttribute || each_field(f.bytes, attribute); });
}

bool parse_tensor(const ProtoField& f, std::vector<OnnxTensor>& list, const Graph& graph) {
  OnnxTensor tensor;
  if (!parse_value(f.bytes, tensor)) return false;
  // Inputs that are weights are many in old files.
  if (list.size() == kMaxTensors && !graph.weights.contains(tensor.name)) return f.number == kGraphInput;
  list.push_back(std::move(tensor));
  return true;
}

bool parse_graph(std::string_view bytes, Graph& graph) {
  return each_field(bytes, [&](const ProtoField& f) {
    if (f.number == kGraphNode) return parse_node(f.bytes, graph);
    if (f.number == kGraphInitializer) return parse_weights(f.bytes, graph);
    if (f.number == kGraphInput) return parse_tensor(f, graph.inputs, graph);
    return f.number != kGraphOutput || parse_tensor(f, graph.outputs, graph);
  });
}

bool parse_opset(std::string_view bytes, OnnxHeader& header) {
  std::string_view domain;
  std::int64_t version = 0;
  const bool sound = each_field(bytes, [&](const ProtoField& f) {
    if (f.number == kOpsetDomain) domain = f.bytes;
    if (f.number == kOpsetVersion) version = static_cast<std::int64_t>(f.value);
    return true;
  });
  if (domain.empty() || domain == "ai.onnx") header.opset = version;
  return sound;
}

Error no_model(const char* detail) { return {Errc::kMalformed, "this is no ONNX file", {}, {}, detail}; }

Result<OnnxHeader> finish(OnnxHeader header, Graph graph) {
  if (graph.external)
    return Error{Errc::kUnsupported,
                 "the model's weights are in another file",
                 {},
                 {},
                 "save it again as one file (onnx.save without save_as_external_data)"};
  if (graph.unfit)
    return Error{Errc::kMalformed,
                 "weights of the model have another size than they say",
                 {},
                 {},
                 "copy the file again, or export it again"};
  for (OnnxTensor& input : graph.inputs)
    if (!graph.weights.contains(input.name)) header.inputs.push_back(std::move(input));
  header.outputs = std::move(graph.outputs);
  if (header.outputs.empty()) return no_model("its graph has no output");
  if (header.inputs.size() != 1)
    return Error{Errc::kMalformed,
                 "a network must have one input, the picture",
                 {},
                 {},
                 "this model has " + std::to_string(header.inputs.size())};
  return header;
}

}  // namespace

Result<OnnxHeader> parse_onnx_header(std::span<const std::byte> file) {
  OnnxHeader header;
  std::optional<std::string_view> graph_bytes;
  ProtoMessage message({reinterpret_cast<const char*>(file.data()), file.size()});
  while (const auto field = message.next()) {
    if (field->number == kModelProducer) header.producer = short_name(field->bytes);
    if (field->number == kModelOpset && !parse_opset(field->bytes, header)) return no_model("its opset cannot be read");
    if (field->number == kModelGraph) graph_bytes = field->bytes;
  }
  if (message.fault() == Errc::kTruncated && message.at() > 0)
    return Error{Errc::kTruncated,
                 "the model ends before it should",
                 {},
                 file.size(),
                 "copy the file again, or it is no ONNX file"};
  if (message.fault()) return no_model("export it from the training framework as ONNX, opset 11 or 12");
  if (!graph_bytes) return no_model("it holds no graph");
  if (header.opset < 1) return no_model("it names no opset, so its end may be missing: copy it again");
  Graph graph;
  if (!parse_graph(*graph_bytes, graph)) return no_model("its graph cannot be read");
  return finish(std::move(header), std::move(graph));
}

std::string shape_text(std::span<const std::int64_t> shape) {
  std::string text;
  for (const std::int64_t size : shape) {
    if (!text.empty()) text += 'x';
    text += size > 0 ? std::to_string(size) : "?";
  }
  return text.empty() ? "a single number" : text;
}

}  // namespace cairn::networks
