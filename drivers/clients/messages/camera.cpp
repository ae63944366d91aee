// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/camera.hpp"

#include "drivers/clients/messages/field_reader.hpp"

namespace cairn::clients {
namespace {

constexpr auto kLastLens = static_cast<std::uint8_t>(CameraMessage::Lens::kEquidistant);
constexpr double kMostPixels = 1e5;

}  // namespace

void encode(const CameraMessage& message, std::vector<std::byte>& out) {
  append_le(out, message.camera);
  append_le(out, static_cast<std::uint8_t>(message.lens));
  append_le(out, static_cast<std::uint8_t>(message.side_by_side));
  append_le(out, std::uint8_t{0});
  append_le(out, message.width);
  append_le(out, message.height);
  for (const double value : {message.fx, message.fy, message.cx, message.cy}) append_le(out, value);
  for (const double value : message.k) append_le(out, value);
  append_le(out, message.baseline_m);
  append_text(out, message.name, CameraMessage::kMaxText);
}

Result<CameraMessage> decode_camera(std::span<const std::byte> body) {
  FieldReader in(body);
  CameraMessage message;
  message.camera = in.up_to<std::uint8_t>(CameraMessage::kMost - 1);
  message.lens = static_cast<CameraMessage::Lens>(in.up_to(kLastLens));
  message.side_by_side = in.up_to(std::uint8_t{1}) != 0;
  in.require(in.number<std::uint8_t>() == 0);
  message.width = in.up_to(CameraMessage::kMaxSide);
  message.height = in.up_to(CameraMessage::kMaxSide);
  for (double* value : {&message.fx, &message.fy, &message.cx, &message.cy}) *value = in.real(kMostPixels);
  for (double& value : message.k) value = in.real();
  message.baseline_m = in.real();
  message.name = in.text(CameraMessage::kMaxText);
  if (!in.complete()) return in.error("not a camera");
  return message;
}

}  // namespace cairn::clients
