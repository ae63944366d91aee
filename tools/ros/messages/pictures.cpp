// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/pictures.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <span>
#include <string_view>
#include <utility>

#include "drivers/camera/camera.hpp"
#include "drivers/camera/convert.hpp"

namespace cairn::ros {
namespace {

using clients::CameraMessage;

constexpr int kQuality = 85;  // of JPEGs, 0 to 100

/// How image_transport calls a picture, and how OpenCV reads it.
struct Form {
  PixelFormat format;
  int type;
  const char *ending, *name;
};
constexpr std::array kForms{
    Form{.format = PixelFormat::kBgr8, .type = CV_8UC3, .ending = ".jpg", .name = "bgr8; jpeg compressed bgr8"},
    Form{.format = PixelFormat::kMono8, .type = CV_8UC1, .ending = ".jpg", .name = "mono8; jpeg compressed "},
    Form{.format = PixelFormat::kMono16, .type = CV_16UC1, .ending = ".png", .name = "mono16; png compressed "},
    Form{.format = PixelFormat::kDepth16, .type = CV_16UC1, .ending = ".png", .name = "16UC1; png compressed "}};

/// The rows behind a picture say how its camera is.
void cut_telemetry(std::uint32_t rows, Image& image) {
  if (rows == 0 || image.height <= static_cast<int>(rows)) return;
  image.height = static_cast<int>(rows);
  image.bytes.resize(image.stride * rows);
}

Error cannot_write(std::string detail) {
  return {Errc::kMalformed, "a picture that cannot be compressed", {}, {}, std::move(detail)};
}

/// plumb_bob has five numbers; the denominator's are zero then.
std::size_t distortion_count(const CameraMessage& camera) {
  if (camera.lens == CameraMessage::Lens::kEquidistant) return 4;
  const bool rational = std::any_of(camera.k.begin() + 5, camera.k.end(), [](double k) { return k != 0; });
  return rational ? 8 : 5;
}

std::string_view distortion_name(const CameraMessage& camera) {
  if (camera.lens == CameraMessage::Lens::kEquidistant) return "equidistant";
  return distortion_count(camera) == 8 ? "rational_polynomial" : "plumb_bob";
}

}  // namespace

Result<const CompressedPicture*> PictureCompressor::compress(const client::PictureMessage& picture,
                                                             const CameraMessage& camera) {
  const auto frame = camera::parse_frame(picture.bytes);
  if (!frame) return frame.error();
  if (frame->info->format == camera::FrameFormat::kMjpg && !camera.side_by_side) {
    out_ = {.format = "jpeg",
            .width = static_cast<int>(frame->header.width),
            .height = static_cast<int>(frame->header.height),
            .bytes = {frame->payload.begin(), frame->payload.end()}};
    return &out_;
  }
  if (const auto decoded = camera::to_image(*frame, both_); !decoded) return decoded.error();
  if (const auto cut = camera.side_by_side ? camera::left_eye(both_, left_) : Result<void>{}; !cut) return cut.error();
  if (!camera.side_by_side) std::swap(both_, left_);
  cut_telemetry(camera.height, left_);
  if (const auto encoded = encode(); !encoded) return encoded.error();
  return &out_;
}

Result<void> PictureCompressor::encode() {
  const auto* const form = std::ranges::find(kForms, left_.format, &Form::format);
  if (form == kForms.end()) return cannot_write("its pixels are of an unknown kind");
  const cv::Mat pixels(left_.height, left_.width, form->type, left_.bytes.data(), left_.stride);
  std::vector<unsigned char> bytes;
  try {
    if (!cv::imencode(form->ending, pixels, bytes, {cv::IMWRITE_JPEG_QUALITY, kQuality})) return cannot_write({});
  } catch (const cv::Exception& error) {
    return cannot_write(error.what());
  }
  const auto written = std::as_bytes(std::span(bytes));
  out_ = {
      .format = form->name, .width = left_.width, .height = left_.height, .bytes = {written.begin(), written.end()}};
  return {};
}

std::string optical_frame(const Frames& frames, const CameraMessage& camera) {
  return frames.prefix + camera.name + "_optical";
}

SE3 T_camera_optical() { return {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), Eigen::Vector3d::Zero()}; }

CompressedImage compressed_image_of(const CompressedPicture& picture, const Header& header, Arena& arena) {
  CompressedImage message{};
  message.header = header;
  message.format = arena.text(picture.format);
  const auto data = arena.sequence(message.data, picture.bytes.size());
  if (!data.empty()) std::memcpy(data.data(), picture.bytes.data(), data.size());
  return message;
}

CameraInfo camera_info_of(const CameraMessage& camera, int width, int height, const Header& header, Arena& arena) {
  CameraInfo message{};
  message.header = header;
  message.width = static_cast<std::uint32_t>(width);
  message.height = static_cast<std::uint32_t>(height);
  const bool known =
      camera.lens != CameraMessage::Lens::kUnknown && message.width == camera.width && message.height == camera.height;
  message.distortion_model = arena.text(known ? distortion_name(camera) : "");
  const auto d = arena.sequence(message.d, known ? distortion_count(camera) : 0);
  std::copy_n(camera.k.begin(), d.size(), d.begin());
  if (!known) return message;
  const auto set = [&](double* k, std::size_t columns) {
    k[0] = camera.fx;
    k[2] = camera.cx;
    k[columns + 1] = camera.fy;
    k[columns + 2] = camera.cy;
    k[2 * columns + 2] = 1;
  };
  set(message.k, 3);
  set(message.p, 4);
  for (const std::size_t i : {0U, 4U, 8U}) message.r[i] = 1;
  return message;
}

}  // namespace cairn::ros
