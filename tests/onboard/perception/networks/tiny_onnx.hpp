// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cairn::networks::test {

/// One protobuf message, field by field.
class Proto {
 public:
  Proto& number(std::uint32_t field, std::uint64_t value) {
    varint(std::uint64_t{field} << 3U);
    varint(value);
    return *this;
  }
  Proto& bytes(std::uint32_t field, std::string_view value) {
    varint(std::uint64_t{field} << 3U | 2U);
    varint(value.size());
    text_ += value;
    return *this;
  }
  Proto& message(std::uint32_t field, const Proto& value) { return bytes(field, value.text_); }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void varint(std::uint64_t value) {
    for (; value >= 0x80U; value >>= 7U) text_ += static_cast<char>(value | 0x80U);
    text_ += static_cast<char>(value);
  }
  std::string text_;
};

/// A small ONNX model, written by hand (onnx.proto3), so that tests need no file of others.
class TinyOnnx {
 public:
  using Shape = std::vector<std::int64_t>;

  explicit TinyOnnx(std::int64_t opset = 11) : opset_(opset) {}

  TinyOnnx& input(const std::string& name, const Shape& shape) { return value(11, name, shape); }
  TinyOnnx& output(const std::string& name, const Shape& shape) { return value(12, name, shape); }
  TinyOnnx& weights(const std::string& name, const Shape& shape, const std::vector<float>& values) {
    std::string raw;
    for (const float v : values) append(raw, std::bit_cast<std::uint32_t>(v), 4);
    return tensor(name, shape, 1, raw);
  }
  TinyOnnx& integers(const std::string& name, const std::vector<std::int64_t>& values) {
    std::string raw;
    for (const std::int64_t v : values) append(raw, static_cast<std::uint64_t>(v), 8);
    return tensor(name, {static_cast<std::int64_t>(values.size())}, 7, raw);
  }
  TinyOnnx& node(const std::string& op, const std::vector<std::string>& inputs, const std::string& output,
                 const std::string& attribute = {}, const std::vector<std::int64_t>& values = {}) {
    Proto n;
    for (const auto& input : inputs) n.bytes(1, input);
    n.bytes(2, output).bytes(3, op + "_" + output).bytes(4, op);
    if (!attribute.empty()) {
      Proto a;
      a.bytes(1, attribute).number(20, 7);
      for (const std::int64_t v : values) a.number(8, static_cast<std::uint64_t>(v));
      n.message(5, a);
    }
    graph_.message(1, n);
    return *this;
  }
  /// Any further field of the graph.
  TinyOnnx& raw(std::uint32_t field, const Proto& value) {
    graph_.message(field, value);
    return *this;
  }

  [[nodiscard]] std::string text() const {
    Proto model = Proto().number(1, 6).bytes(2, "tests");
    Proto graph = graph_;
    graph.bytes(2, "tiny");
    return model.message(7, graph).message(8, Proto().number(2, static_cast<std::uint64_t>(opset_))).text();
  }
  void save(const std::filesystem::path& path) const { std::ofstream(path, std::ios::binary) << text(); }

 private:
  static void append(std::string& raw, std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) raw += static_cast<char>(value >> (8 * i));
  }
  TinyOnnx& value(std::uint32_t field, const std::string& name, const Shape& shape) {
    Proto dimensions;
    for (const std::int64_t size : shape)
      dimensions.message(1, size > 0 ? Proto().number(1, static_cast<std::uint64_t>(size)) : Proto().bytes(2, "N"));
    const Proto type = Proto().message(1, Proto().number(1, 1).message(2, dimensions));
    return raw(field, Proto().bytes(1, name).message(2, type));
  }
  TinyOnnx& tensor(const std::string& name, const Shape& shape, std::uint64_t type, const std::string& bytes) {
    Proto t;
    for (const std::int64_t size : shape) t.number(1, static_cast<std::uint64_t>(size));
    return raw(5, t.number(2, type).bytes(8, name).bytes(9, bytes));
  }

  std::int64_t opset_;
  Proto graph_;
};

/// A convolution of 1x1: output plane o is bias[o] + Σ weights[o][i] · input plane i.
inline TinyOnnx convolution(std::int64_t width, std::int64_t height, const std::vector<std::vector<float>>& weights,
                            const std::vector<float>& bias, std::int64_t opset = 11) {
  const auto out = static_cast<std::int64_t>(weights.size()), in = static_cast<std::int64_t>(weights.front().size());
  std::vector<float> flat;
  for (const auto& row : weights) flat.insert(flat.end(), row.begin(), row.end());
  TinyOnnx model(opset);
  model.input("picture", {1, in, height, width}).weights("w", {out, in, 1, 1}, flat).weights("b", {out}, bias);
  return model.node("Conv", {"picture", "w", "b"}, "planes", "kernel_shape", {1, 1});
}

/// Three classes: the more of a colour (blue, green, red), the more of class 0, 1, 2.
inline TinyOnnx colours(std::int64_t width = 6, std::int64_t height = 4, std::int64_t opset = 11) {
  return convolution(width, height, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}, opset)
      .output("planes", {1, 3, height, width});
}

/// A table of constants, whatever the picture: `values` has rows × columns numbers.
inline TinyOnnx table(std::int64_t width, std::int64_t height, const TinyOnnx::Shape& shape,
                      const std::vector<float>& values) {
  // A plane for each number, of which the mean over the picture is left.
  std::vector<std::vector<float>> weights(values.size(), {0, 0, 0});
  TinyOnnx model = convolution(width, height, weights, values);
  model.integers("shape", shape).node("GlobalAveragePool", {"planes"}, "numbers");
  return model.node("Reshape", {"numbers", "shape"}, "rows").output("rows", shape);
}

}  // namespace cairn::networks::test
