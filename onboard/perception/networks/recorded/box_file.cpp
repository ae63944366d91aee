// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/recorded/box_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <utility>

#include "hal/files/file.hpp"
#include "onboard/perception/networks/config/comma_list.hpp"

namespace cairn::networks {
namespace {

constexpr std::size_t kMaxCameraName = 64, kEmptyParts = 2, kBoxParts = 8, kMaxCameras = 16;
constexpr float kFarthest = 1e5F;  // pixels

bool is_camera(std::string_view name) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.'; };
  return !name.empty() && name.size() <= kMaxCameraName && std::all_of(name.begin(), name.end(), fits);
}

/// False for what is not a number, too.
bool within(float value, float low, float high) { return value >= low && value <= high; }

bool is_box(const Detection& d) {
  return within(d.x, -kFarthest, kFarthest) && within(d.y, -kFarthest, kFarthest) && within(d.width, 0, kFarthest) &&
         within(d.height, 0, kFarthest) && within(d.score, 0, 1) && d.class_id < kSemanticClasses.size();
}

template <class Number>
bool read(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

/// What is wrong with the line, or null.
const char* parse_line(const std::vector<std::string_view>& parts, RecordedBoxes& line) {
  std::int64_t ns = 0;
  if (parts.size() != kEmptyParts && parts.size() != kBoxParts)
    return "stamp_ns,camera,x,y,width,height,class,score expected, or stamp_ns,camera for a picture without boxes";
  if (!read(parts[0], ns)) return "not a stamp in nanoseconds";
  line.stamp = Time(Duration(ns));
  if (!is_camera(parts[1])) return "a camera's name has letters, digits, `_`, `-` and `.`";
  line.camera = parts[1];
  line.found.clear();
  if (parts.size() == kEmptyParts) return nullptr;
  Detection d;
  if (!read(parts[2], d.x) || !read(parts[3], d.y) || !read(parts[4], d.width) || !read(parts[5], d.height) ||
      !read(parts[6], d.class_id) || !read(parts[7], d.score))
    return "x, y, width, height and score are numbers, class is a trainId";
  if (!is_box(d)) return "a box lies near its picture, a trainId is 0 to 18, a score is 0 to 1";
  line.found.push_back(d);
  return nullptr;
}

/// What is wrong with the line after the ones before it, or null.
const char* append(RecordedBoxes line, std::vector<RecordedBoxes>& pictures) {
  if (!pictures.empty() && line.stamp < pictures.back().stamp) return "the stamps decrease";
  std::size_t cameras = 0;  // that have lines of this stamp
  for (auto same = pictures.rbegin(); same != pictures.rend() && same->stamp == line.stamp; ++same, ++cameras) {
    if (cameras == kMaxCameras) return "too many cameras have the same stamp";
    if (same->camera != line.camera) continue;
    if (line.found.empty() || same->found.empty()) return "the picture has other lines, too";
    if (same->found.size() == kMaxBoxesOfPicture) return "the picture has too many boxes";
    same->found.push_back(line.found.front());
    return nullptr;
  }
  if (pictures.size() == kMaxBoxPictures) return "the file has too many pictures";
  pictures.push_back(std::move(line));
  return nullptr;
}

template <class Number>
void print(std::string& text, Number value) {
  char buffer[32];
  text += ',';
  text.append(buffer, std::to_chars(std::begin(buffer), std::end(buffer), value).ptr);
}

}  // namespace

Result<void> parse_boxes(std::string_view text, std::string_view name, std::vector<RecordedBoxes>& pictures) {
  std::uint64_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view content = text.substr(at, end - at);
    if (content.ends_with('\r')) content.remove_suffix(1);
    ++number;
    const auto parts = content.starts_with('#') ? std::vector<std::string_view>() : comma_list(content);
    RecordedBoxes line;
    const char* fault = parts.empty() ? nullptr : parse_line(parts, line);
    if (fault == nullptr && !parts.empty()) fault = append(std::move(line), pictures);
    if (fault != nullptr)
      return Error{Errc::kMalformed, "a line of boxes cannot be used", std::string(name) + ":" + std::to_string(number),
                   at, fault};
    at = end + 1;
  }
  return {};
}

std::string to_csv(const RecordedBoxes& picture) {
  const std::string start = std::to_string(picture.stamp.time_since_epoch().count()) + "," + picture.camera;
  if (picture.found.empty()) return start + "\n";
  std::string text;
  for (const Detection& d : picture.found) {
    text += start;
    for (const float value : {d.x, d.y, d.width, d.height}) print(text, value);
    print(text, static_cast<int>(d.class_id));
    print(text, d.score);
    text += '\n';
  }
  return text;
}

Result<std::unique_ptr<RecordedDetector>> RecordedDetector::open(const std::filesystem::path& file,
                                                                 const std::string& camera) {
  const auto bytes = read_file(file, kMaxBoxFileBytes);
  if (!bytes) return bytes.error();
  std::unique_ptr<RecordedDetector> detector(new RecordedDetector);
  detector->name_ = file.string();
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  if (auto parsed = parse_boxes(text, detector->name_, detector->pictures_); !parsed)
    detector->damage_ = parsed.error();
  std::erase_if(detector->pictures_, [&](const RecordedBoxes& p) { return p.camera != camera; });
  return detector;
}

Result<const Detections*> RecordedDetector::detect(const Image& picture) {
  const auto found = std::lower_bound(pictures_.begin(), pictures_.end(), picture.stamp,
                                      [](const RecordedBoxes& p, Time stamp) { return p.stamp < stamp; });
  if (found == pictures_.end() || found->stamp != picture.stamp)
    return Error{Errc::kNotFound,
                 "no boxes of this picture are recorded",
                 name_,
                 {},
                 "stamp " + std::to_string(picture.stamp.time_since_epoch().count())};
  detections_ = {picture.source, picture.stamp, picture.width, picture.height, {}};
  const auto w = static_cast<float>(picture.width), h = static_cast<float>(picture.height);
  for (const Detection& d : found->found) {
    const float left = std::clamp(d.x, 0.0F, w), top = std::clamp(d.y, 0.0F, h);
    const float right = std::clamp(d.x + d.width, left, w), bottom = std::clamp(d.y + d.height, top, h);
    if (right > left && bottom > top)
      detections_.found.push_back({.x = left,
                                   .y = top,
                                   .width = right - left,
                                   .height = bottom - top,
                                   .class_id = d.class_id,
                                   .score = d.score});
  }
  return &detections_;
}

Result<BoxWriter> BoxWriter::create(const std::filesystem::path& path) {
  auto file = AppendFile::create(path);
  if (!file) return file.error();
  if (auto header = file->append_line(kBoxHeader); !header) return header.error();
  return BoxWriter(std::move(*file));
}

Result<void> BoxWriter::write(const std::string& camera, const Detections& detections) {
  const auto refuse = [&](std::string_view cause) {
    return Error{Errc::kMalformed, cause, file_.path().string(), {}, {}};
  };
  if (last_ && detections.stamp < *last_) return refuse("a picture's stamp is below the last one");
  if (!is_camera(camera)) return refuse("a camera's name has letters, digits, `_`, `-` and `.`");
  if (!std::all_of(detections.found.begin(), detections.found.end(), is_box) ||
      detections.found.size() > kMaxBoxesOfPicture)
    return refuse("a detector's boxes cannot be kept");
  if (auto written = file_.append_line(to_csv({detections.stamp, camera, detections.found})); !written) return written;
  last_ = detections.stamp;
  return {};
}

}  // namespace cairn::networks
