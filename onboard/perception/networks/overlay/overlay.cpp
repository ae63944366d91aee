// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/overlay/overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

namespace cairn::networks {
namespace {

constexpr double kFontScale = 0.45;
constexpr int kLineHeight = 20, kEntryWidth = 130;  // of the legend, pixels

/// The picture's own memory as a matrix.
cv::Mat canvas_of(Image& colour) { return {colour.height, colour.width, CV_8UC3, colour.bytes.data(), colour.stride}; }

cv::Scalar colour_of(std::uint8_t class_id) {
  const SemanticClass& c = kSemanticClasses[class_id];
  return {static_cast<double>(c.b), static_cast<double>(c.g), static_cast<double>(c.r)};
}

void write_text(cv::Mat& canvas, const std::string& text, cv::Point at, const cv::Scalar& colour) {
  cv::putText(canvas, text, at, cv::FONT_HERSHEY_SIMPLEX, kFontScale, colour, 1, cv::LINE_AA);
}

/// Text on a field of the class's colour, above `corner` where there is room.
void write_sign(cv::Mat& canvas, const std::string& text, cv::Point corner, std::uint8_t class_id) {
  int below = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kFontScale, 1, &below);
  const int right = std::max(canvas.cols - size.width - 6, 0);
  const cv::Rect field(std::clamp(corner.x, 0, right), std::max(corner.y - size.height - below - 2, 0), size.width + 6,
                       size.height + below + 2);
  cv::rectangle(canvas, field, colour_of(class_id), cv::FILLED);
  const SemanticClass& c = kSemanticClasses[class_id];
  const bool bright = 3 * c.r + 6 * c.g + c.b > 1500;  // as eyes weigh the colours
  write_text(canvas, text, {field.x + 3, field.y + size.height + 1}, cv::Scalar::all(bright ? 0 : 255));
}

/// Classes with at least 1 % of the pixels, in the order of their trainIds.
std::vector<std::uint8_t> frequent_classes(const LabelImage& labels) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t id : labels.classes) ++counts[id];
  std::vector<std::uint8_t> ids;
  for (std::size_t id = 0; id < kSemanticClasses.size(); ++id)
    if (counts[id] > 0 && counts[id] * 100 >= labels.classes.size()) ids.push_back(static_cast<std::uint8_t>(id));
  return ids;
}

}  // namespace

Result<void> to_colour(const Image& picture, int wide, Image& colour) {
  const bool grey = picture.format == PixelFormat::kMono8;
  if ((!grey && picture.format != PixelFormat::kBgr8) || picture.view().empty())
    return Error{Errc::kUnsupported, "only colour and grey pictures with 8 bits can be painted on"};
  const int factor = std::max(1, wide / picture.width);
  colour.source = picture.source;
  colour.stamp = picture.stamp;
  colour.resize(PixelFormat::kBgr8, factor * picture.width, factor * picture.height);
  const ImageView in = picture.view();
  for (int y = 0; y < colour.height; ++y) {
    std::byte* out = colour.bytes.data() + static_cast<std::size_t>(y) * colour.stride;
    for (int x = 0; x < colour.width; ++x)
      for (int c = 0; c < 3; ++c) *out++ = in.at<std::byte>(x / factor, y / factor, grey ? 0 : c);
  }
  return {};
}

void paint_labels(const LabelImage& labels, double opacity, Image& colour) {
  if (labels.width < 1 || labels.height < 1) return;
  cv::Mat canvas = canvas_of(colour);
  const double keep = 1 - std::clamp(opacity, 0.0, 1.0);
  for (int y = 0; y < canvas.rows; ++y)
    for (int x = 0; x < canvas.cols; ++x) {
      const auto label_x = static_cast<int>(std::int64_t{x} * labels.width / canvas.cols);
      const auto label_y = static_cast<int>(std::int64_t{y} * labels.height / canvas.rows);
      const std::uint8_t id = labels.classes[labels.index(label_x, label_y)];
      if (id >= kSemanticClasses.size()) continue;
      const cv::Scalar paint = colour_of(id);
      auto& pixel = canvas.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::uint8_t>(std::lround(keep * pixel[c] + (1 - keep) * paint[c]));
    }
}

void paint_boxes(const Detections& detections, Image& colour) {
  cv::Mat canvas = canvas_of(colour);
  const cv::Scalar white(255, 255, 255);
  const float scale =
      detections.width > 0 ? static_cast<float>(colour.width) / static_cast<float>(detections.width) : 1;
  const auto pixels = [scale](float value) { return static_cast<int>(value * scale); };
  for (const Detection& d : detections.found) {
    if (d.class_id >= kSemanticClasses.size()) continue;
    const cv::Rect box(pixels(d.x), pixels(d.y), pixels(d.width), pixels(d.height));
    cv::rectangle(canvas, box, white, 3);
    cv::rectangle(canvas, box, colour_of(d.class_id), 1);
    const std::string text =
        std::string(kSemanticClasses[d.class_id].name) + " " + std::to_string(std::lround(100 * d.score));
    write_sign(canvas, text, box.tl(), d.class_id);
  }
}

void add_legend(const LabelImage& labels, Image& colour) {
  const auto ids = frequent_classes(labels);
  const int columns = std::max(1, colour.width / kEntryWidth);
  const int lines = (static_cast<int>(ids.size()) + columns - 1) / columns;
  const int top = colour.height;
  colour.resize(PixelFormat::kBgr8, colour.width, top + lines * kLineHeight);
  cv::Mat canvas = canvas_of(colour);
  canvas.rowRange(top, canvas.rows).setTo(cv::Scalar::all(255));
  for (int i = 0; i < static_cast<int>(ids.size()); ++i) {
    const std::uint8_t id = ids[static_cast<std::size_t>(i)];
    const cv::Point corner(i % columns * kEntryWidth + 4, top + i / columns * kLineHeight + 4);
    cv::rectangle(canvas, cv::Rect(corner, cv::Size(12, 12)), colour_of(id), cv::FILLED);
    write_text(canvas, std::string(kSemanticClasses[id].name), corner + cv::Point(17, 11), cv::Scalar::all(0));
  }
}

Result<std::vector<std::byte>> encode_png(const Image& colour) {
  try {
    Image copy = colour;
    std::vector<uchar> out;
    if (!cv::imencode(".png", canvas_of(copy), out)) return Error{Errc::kIo, "OpenCV cannot encode the picture"};
    const auto bytes = std::as_bytes(std::span(out));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  } catch (const std::exception& e) {
    return Error{Errc::kIo, "OpenCV cannot encode the picture", {}, {}, e.what()};
  }
}

}  // namespace cairn::networks
