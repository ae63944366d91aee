// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/answers/boxes.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::networks {
namespace {

constexpr std::size_t kYoloxBox = 5;  // x, y, width, height, objectness
constexpr std::size_t kSsdColumns = 7;
// A box is at most so many times its stride, which no picture reaches: e^x would overflow.
constexpr float kLargestLog = 12.0F;

/// False for what is not a number, too.
bool in(float value, float low, float high) { return value >= low && value <= high; }

bool sound(const Candidate& c) {
  constexpr float kFar = 1e6F;
  return in(c.left, -kFar, kFar) && in(c.top, -kFar, kFar) && in(c.right, -kFar, kFar) && in(c.bottom, -kFar, kFar) &&
         in(c.score, 0.0F, 1.0F);
}

/// Column and score of the best class of a row; the first of equal ones.
std::pair<std::size_t, float> best_class(std::span<const float> scores) {
  const auto best = std::max_element(scores.begin(), scores.end());
  return {static_cast<std::size_t>(best - scores.begin()), *best};
}

void read_cell(std::span<const float> row, float x, float y, float stride, float threshold,
               std::vector<Candidate>& candidates) {
  const float something = row[4];
  if (!(something >= threshold)) return;  // a class's score is at most 1
  const auto [channel, score] = best_class(row.subspan(kYoloxBox));
  if (!(something * score >= threshold)) return;
  const float centre_x = (row[0] + x) * stride, centre_y = (row[1] + y) * stride;
  const float half_width = std::exp(std::min(row[2], kLargestLog)) * stride / 2;
  const float half_height = std::exp(std::min(row[3], kLargestLog)) * stride / 2;
  const Candidate c{
      centre_x - half_width, centre_y - half_height, centre_x + half_width, centre_y + half_height, channel,
      something * score};
  if (sound(c)) candidates.push_back(c);
}

float area(const Detection& d) { return d.width * d.height; }

float intersection_over_union(const Detection& a, const Detection& b) {
  const float width = std::min(a.x + a.width, b.x + b.width) - std::max(a.x, b.x);
  const float height = std::min(a.y + a.height, b.y + b.height) - std::max(a.y, b.y);
  if (width <= 0 || height <= 0) return 0;
  return width * height / (area(a) + area(b) - width * height);
}

Detection to_picture(const Candidate& c, std::uint8_t class_id, const Placement& p) {
  const auto x = [&](float value) {
    return std::clamp(static_cast<float>(value / p.scale_x), 0.0F, static_cast<float>(p.picture_width));
  };
  const auto y = [&](float value) {
    return std::clamp(static_cast<float>(value / p.scale_y), 0.0F, static_cast<float>(p.picture_height));
  };
  const float left = x(c.left), top = y(c.top);
  return {.x = left,
          .y = top,
          .width = x(c.right) - left,
          .height = y(c.bottom) - top,
          .class_id = class_id,
          .score = c.score};
}

}  // namespace

std::size_t yolox_rows(int width, int height, std::span<const int> strides) {
  std::size_t rows = 0;
  for (const int stride : strides)
    rows += static_cast<std::size_t>(width / stride) * static_cast<std::size_t>(height / stride);
  return rows;
}

void read_yolox(std::span<const float> rows, std::size_t columns, int width, int height, std::span<const int> strides,
                float threshold, std::vector<Candidate>& candidates) {
  std::size_t at = 0;
  for (const int stride : strides)
    for (int y = 0; y < height / stride; ++y)
      for (int x = 0; x < width / stride; ++x, at += columns)
        read_cell(rows.subspan(at, columns), static_cast<float>(x), static_cast<float>(y), static_cast<float>(stride),
                  threshold, candidates);
}

void read_ssd_rows(std::span<const float> rows, int width, int height, float threshold,
                   std::vector<Candidate>& candidates) {
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  for (std::size_t at = 0; at + kSsdColumns <= rows.size(); at += kSsdColumns) {
    const auto row = rows.subspan(at, kSsdColumns);
    // The list is padded with rows of picture -1.
    if (!in(row[0], 0, 0) || !in(row[1], 0, 1e6F) || !(row[2] >= threshold)) continue;
    const Candidate c{row[3] * w, row[4] * h, row[5] * w, row[6] * h, static_cast<std::size_t>(row[1]), row[2]};
    if (sound(c)) candidates.push_back(c);
  }
}

void read_ssd_pair(std::span<const float> scores, std::size_t columns, std::span<const float> boxes, int width,
                   int height, float threshold, std::vector<Candidate>& candidates) {
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  for (std::size_t i = 0; i < boxes.size() / 4; ++i) {
    const auto [channel, score] = best_class(scores.subspan(i * columns + 1, columns - 1));
    if (!(score >= threshold)) continue;
    const auto box = boxes.subspan(i * 4, 4);
    const Candidate c{box[0] * w, box[1] * h, box[2] * w, box[3] * h, channel + 1, score};
    if (sound(c)) candidates.push_back(c);
  }
}

void select_boxes(std::vector<Candidate>& candidates, const ClassMap& classes, const BoxRules& rules,
                  const Placement& placement, std::vector<Detection>& found) {
  found.clear();
  std::erase_if(candidates, [&](const Candidate& c) { return classes[c.channel] == kNoClass; });
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  if (candidates.size() > kMaxCandidates) candidates.resize(kMaxCandidates);
  for (const Candidate& c : candidates) {
    const Detection box = to_picture(c, classes[c.channel], placement);
    if (box.width <= 0 || box.height <= 0) continue;
    const auto covers = [&](const Detection& better) {
      return better.class_id == box.class_id && intersection_over_union(better, box) > rules.nms_threshold;
    };
    if (std::none_of(found.begin(), found.end(), covers)) found.push_back(box);
    if (found.size() == kMaxBoxes) return;
  }
}

}  // namespace cairn::networks
