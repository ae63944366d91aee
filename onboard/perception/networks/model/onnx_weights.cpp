// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/model/onnx_weights.hpp"

#include <algorithm>

#include "onboard/perception/networks/model/proto_message.hpp"

namespace cairn::networks {
namespace {

// Field numbers of TensorProto in onnx.proto3.
enum Number : std::uint32_t {
  kDims = 1,
  kDataType = 2,
  kFloats = 4,
  kInt32s = 5,
  kInt64s = 7,
  kName = 8,
  kRaw = 9,
  kDoubles = 10,
  kLocation = 14
};
// TensorProto.DataType
enum Type : std::uint64_t {
  kFloat = 1,
  kUint8 = 2,
  kInt8 = 3,
  kUint16 = 4,
  kInt16 = 5,
  kInt32 = 6,
  kInt64 = 7,
  kBool = 9,
  kFloat16 = 10,
  kDouble = 11
};

/// Bytes of a value in raw data; 0: a type that OpenCV does not read.
std::uint64_t bytes_of(std::uint64_t type) {
  switch (type) {
    case kUint8:
    case kInt8:
    case kBool:
      return 1;
    case kUint16:
    case kInt16:
    case kFloat16:
      return 2;
    case kFloat:
    case kInt32:
      return 4;
    case kInt64:
    case kDouble:
      return 8;
    default:
      return 0;
  }
}

/// Numbers of variable length: each ends with a byte below 128.
std::uint64_t varints_in(const ProtoField& f) {
  if (!f.packed) return 1;
  return static_cast<std::uint64_t>(
      std::count_if(f.bytes.begin(), f.bytes.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80U; }));
}

void multiply(std::uint64_t size, OnnxWeights& w) {
  constexpr std::uint64_t kTooMany = OnnxWeights::kMostElements + 1;
  w.elements = size > OnnxWeights::kMostElements ? kTooMany : std::min(w.elements * size, kTooMany);
}

bool take_dims(const ProtoField& f, OnnxWeights& w) {
  if (!f.packed) {
    multiply(f.value, w);
    return true;
  }
  std::uint64_t size = 0;
  unsigned shift = 0;
  for (const char c : f.bytes) {
    if (shift > 56) return false;
    size |= std::uint64_t{static_cast<unsigned char>(c) & 0x7FU} << shift;
    shift += 7;
    if (static_cast<unsigned char>(c) >= 0x80U) continue;
    multiply(size, w);
    size = 0;
    shift = 0;
  }
  return shift == 0;
}

}  // namespace

bool OnnxWeights::complete() const {
  const std::uint64_t size = bytes_of(type);
  if (size == 0) return true;
  if (elements > kMostElements) return false;
  if (has_raw && raw_bytes != elements * size) return false;
  const std::uint64_t typed = type == kFloat ? floats : type == kDouble ? doubles : type == kInt64 ? int64s : int32s;
  return typed == elements || (typed == 0 && has_raw);
}

bool parse_onnx_weights(std::string_view bytes, OnnxWeights& w) {
  return each_field(bytes, [&](const ProtoField& f) {
    if (f.number == kDims) return take_dims(f, w);
    if (f.number == kDataType) w.type = f.value;
    if (f.number == kName) w.name = f.bytes;
    if (f.number == kLocation) w.external = f.value == 1;
    if (f.number == kFloats) w.floats += f.packed ? f.bytes.size() / 4 : 1;
    if (f.number == kDoubles) w.doubles += f.packed ? f.bytes.size() / 8 : 1;
    if (f.number == kInt32s) w.int32s += varints_in(f);
    if (f.number == kInt64s) w.int64s += varints_in(f);
    if (f.number == kRaw) {
      w.has_raw = true;
      w.raw_bytes = f.bytes.size();
    }
    return true;
  });
}

}  // namespace cairn::networks
