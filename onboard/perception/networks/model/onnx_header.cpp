// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/model/onnx_header.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

namespace cairn::networks {
namespace {

constexpr std::size_t kMaxTensors = 64, kMaxDimensions = 8, kMaxName = 256;

// Field numbers of onnx.proto3.
constexpr std::uint32_t kModelProducer = 2, kModelGraph = 7, kModelOpset = 8;
constexpr std::uint32_t kGraphInitializer = 5, kGraphInput = 11, kGraphOutput = 12;
constexpr std::uint32_t kOpsetDomain = 1, kOpsetVersion = 2;
constexpr std::uint32_t kTensorName = 8, kTensorLocation = 14;
constexpr std::uint32_t kValueName = 1, kValueType = 2;
constexpr std::uint32_t kTypeTensor = 1, kTensorShape = 2, kShapeDimension = 1, kDimensionValue = 1;

/// One field of a message: a number, or bytes.
struct Field {
  std::uint32_t number = 0;
  std::uint64_t value = 0;
  std::string_view bytes;
};

/// Walks over the fields of one protobuf message. It ends early where the bytes are no message.
class Message {
 public:
  explicit Message(std::string_view bytes) : bytes_(bytes) {}

  std::optional<Field> next() {
    if (at_ == bytes_.size() || fault_) return std::nullopt;
    const auto key = varint();
    if (!key) return std::nullopt;
    Field field;
    field.number = static_cast<std::uint32_t>(*key >> 3U);
    if (field.number == 0 || *key >> 32U != 0) return fail(Errc::kMalformed);
    switch (*key & 7U) {
      case 0:
        field.value = varint().value_or(0);
        break;
      case 1:
        take(8);
        break;
      case 2:
        field.bytes = take(varint().value_or(0));
        break;
      case 5:
        take(4);
        break;
      default:
        return fail(Errc::kMalformed);
    }
    if (fault_) return std::nullopt;
    return field;
  }
  [[nodiscard]] std::optional<Errc> fault() const { return fault_; }
  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  std::optional<Field> fail(Errc code) {
    fault_ = code;
    return std::nullopt;
  }
  std::optional<std::uint64_t> varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      if (at_ == bytes_.size()) {
        fault_ = Errc::kTruncated;
        return std::nullopt;
      }
      const auto byte = static_cast<unsigned char>(bytes_[at_++]);
      value |= std::uint64_t{byte & 0x7FU} << shift;
      if (byte < 0x80U) return value;
    }
    fault_ = Errc::kMalformed;
    return std::nullopt;
  }
  std::string_view take(std::uint64_t size) {
    if (fault_) return {};
    if (size > bytes_.size() - at_) {
      fault_ = Errc::kTruncated;
      return {};
    }
    const std::string_view taken = bytes_.substr(at_, static_cast<std::size_t>(size));
    at_ += taken.size();
    return taken;
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  std::optional<Errc> fault_;
};

/// Calls `take` for each field. False: the bytes are no message, or `take` says so.
template <class Take>
bool each_field(std::string_view bytes, Take take) {
  Message message(bytes);
  while (const auto field = message.next())
    if (!take(*field)) return false;
  return !message.fault();
}

std::string short_name(std::string_view name) { return std::string(name.substr(0, kMaxName)); }

bool parse_dimension(std::string_view bytes, OnnxTensor& tensor) {
  std::int64_t size = 0;
  if (!each_field(bytes, [&](const Field& f) {
        if (f.number == kDimensionValue) size = static_cast<std::int64_t>(f.value);
        return true;
      }))
    return false;
  if (tensor.shape.size() == kMaxDimensions) return false;
  tensor.shape.push_back(std::max<std::int64_t>(size, 0));
  return true;
}

bool parse_value(std::string_view bytes, OnnxTensor& tensor) {
  const auto shape = [&](const Field& f) { return f.number != kShapeDimension || parse_dimension(f.bytes, tensor); };
  const auto type = [&](const Field& f) { return f.number != kTensorShape || each_field(f.bytes, shape); };
  return each_field(bytes, [&](const Field& f) {
    if (f.number == kValueName) tensor.name = short_name(f.bytes);
    if (f.number != kValueType) return true;
    return each_field(f.bytes, [&](const Field& t) { return t.number != kTypeTensor || each_field(t.bytes, type); });
  });
}

struct Graph {
  std::vector<OnnxTensor> inputs, outputs;
  std::set<std::string_view> weights;  // files of old versions list them among the inputs
  bool external = false;
};

bool parse_weights(std::string_view bytes, Graph& graph) {
  return each_field(bytes, [&](const Field& f) {
    if (f.number == kTensorName) graph.weights.insert(f.bytes);
    if (f.number == kTensorLocation && f.value == 1) graph.external = true;
    return true;
  });
}

bool parse_graph(std::string_view bytes, Graph& graph) {
  return each_field(bytes, [&](const Field& f) {
    if (f.number == kGraphInitializer) return parse_weights(f.bytes, graph);
    if (f.number != kGraphInput && f.number != kGraphOutput) return true;
    auto& list = f.number == kGraphInput ? graph.inputs : graph.outputs;
    OnnxTensor tensor;
    if (!parse_value(f.bytes, tensor)) return false;
    // Inputs that are weights are many in old files.
    if (list.size() == kMaxTensors && !graph.weights.contains(tensor.name)) return f.number == kGraphInput;
    list.push_back(std::move(tensor));
    return true;
  });
}

bool parse_opset(std::string_view bytes, OnnxHeader& header) {
  std::string_view domain;
  std::int64_t version = 0;
  const bool sound = each_field(bytes, [&](const Field& f) {
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
  Message message({reinterpret_cast<const char*>(file.data()), file.size()});
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
