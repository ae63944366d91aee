// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/place_memory.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "onboard/perception/stereo/as_mat.hpp"

namespace cairn::visual_odometry {
namespace {

constexpr int kReach_px = 15;      // of a patch around its pixel, at scale 1
constexpr int kSmooth_px = 4;      // from the middle of the box that smooths the picture, as BRIEF's authors have it
constexpr double kReach_m = 0.26;  // of the patch of a corner whose distance is known: 15 pixels of a ZED at 6 m
constexpr float kSmallest = 0.4F;  // scales: smaller patches say too little,
constexpr float kLargest = 2.5F;   // and larger ones reach over edges
constexpr int kFarthest = 60;      // of 256 bits that may differ
constexpr double kClearer = 0.85;  // the best match differs by so much less than the second
constexpr std::size_t kLeastMatches = 12;

struct Comparison {
  int ax, ay, bx, by;
};

/// Places within the patch, denser in the middle; the same in every program. In tenths of a pixel at scale 1.
std::array<Comparison, 256> comparisons() {
  static constexpr int kReach = 10 * kReach_px;
  std::uint32_t state = 20100905;
  const auto coordinate = [&state] {
    int sum = 0;  // of four uniform numbers: nearly normal
    for (int i = 0; i < 4; ++i) {
      state = state * 1664525U + 1013904223U;  // Knuth's, by Press et al., Numerical Recipes
      sum += static_cast<int>(state >> 24U);
    }
    return std::clamp((sum - 510) * kReach / 400, -kReach, kReach);
  };
  std::array<Comparison, 256> all{};
  for (Comparison& c : all) c = {coordinate(), coordinate(), coordinate(), coordinate()};
  return all;
}

int differing_bits(const Descriptor& a, const Descriptor& b) {
  int bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) bits += std::popcount(a[i] ^ b[i]);
  return bits;
}

/// Sums over boxes of a picture.
class Boxes {
 public:
  explicit Boxes(const Image& picture) { cv::integral(stereo::as_mat(picture), sums_, CV_32S); }

  /// Over the box that reaches `half` pixels from its middle. At the edges of the picture it is moved inside.
  [[nodiscard]] int around(int x, int y, int half) const {
    const int width = sums_.cols - 1, height = sums_.rows - 1;
    x = std::clamp(x, half, width - 1 - half);
    y = std::clamp(y, half, height - 1 - half);
    return sums_.at<int>(y + half + 1, x + half + 1) - sums_.at<int>(y - half, x + half + 1) -
           sums_.at<int>(y + half + 1, x - half) + sums_.at<int>(y - half, x - half);
  }
  /// The largest `half` that fits into the picture.
  [[nodiscard]] int largest() const { return (std::min(sums_.cols, sums_.rows) - 2) / 2; }

 private:
  cv::Mat sums_;  // a row and a column more than the picture
};

Descriptor describe_one(const Boxes& boxes, const Spot& spot) {
  static const std::array<Comparison, 256> all = comparisons();
  const int half =
      std::clamp(static_cast<int>(std::lround(kSmooth_px * static_cast<double>(spot.scale))), 1, boxes.largest());
  const double step = 0.1 * static_cast<double>(spot.scale);
  const double x = static_cast<double>(spot.pixel.x()), y = static_cast<double>(spot.pixel.y());
  const auto at = [&](int dx, int dy) {
    return boxes.around(static_cast<int>(std::lround(x + step * dx)), static_cast<int>(std::lround(y + step * dy)),
                        half);
  };
  Descriptor descriptor{};
  for (std::size_t i = 0; i < all.size(); ++i)
    if (at(all[i].ax, all[i].ay) < at(all[i].bx, all[i].by)) descriptor[i / 64] |= std::uint64_t{1} << (i % 64);
  return descriptor;
}

/// The index of the most alike, and whether no other one is nearly as much.
struct Alike {
  std::size_t index = 0;
  bool clear = false;
};
Alike most_alike(const Descriptor& wanted, std::span<const Descriptor> all) {
  int best = 257, second = 257;
  Alike alike;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int bits = differing_bits(wanted, all[i]);
    if (bits < best) {
      second = best;
      best = bits;
      alike.index = i;
    } else {
      second = std::min(second, bits);
    }
  }
  alike.clear = best <= kFarthest && best < kClearer * second;
  return alike;
}

}  // namespace

std::vector<Descriptor> describe(const Image& picture, std::span<const Spot> spots) {
  const Boxes boxes(picture);
  std::vector<Descriptor> descriptors;
  for (const Spot& spot : spots) descriptors.push_back(describe_one(boxes, spot));
  return descriptors;
}

std::vector<Descriptor> PlaceMemory::describe_all(const Image& left, std::span<const Feature> features) const {
  const double per_pixel = kReach_m / (baseline_m_ * kReach_px);  // of disparity
  std::vector<Spot> spots;
  for (const Feature& f : features) {
    const float scale = f.disparity ? static_cast<float>(per_pixel * static_cast<double>(*f.disparity)) : 1.0F;
    spots.push_back({f.left, std::clamp(scale, kSmallest, kLargest)});
  }
  return describe(left, spots);
}

void PlaceMemory::remember(Time stamp, const Image& left, std::span<const Feature> features,
                           const LandmarkMap& landmarks, const SE3& T_odom_base) {
  Keyframe keyframe{.stamp = stamp, .T_odom_base = T_odom_base, .descriptors = {}, .landmarks = {}};
  std::vector<Feature> known;
  for (const Feature& f : features)
    if (const Landmark* landmark = landmarks.find(f.id)) {
      known.push_back(f);
      keyframe.landmarks.push_back(*landmark);
    }
  keyframe.descriptors = describe_all(left, known);
  restore(std::move(keyframe));
}

void PlaceMemory::restore(Keyframe keyframe) {
  keyframes_.push_back(std::move(keyframe));
  if (keyframes_.size() > kPlaces) keyframes_.pop_front();
}

PlaceMemory::Place PlaceMemory::recall(const Image& left, std::span<const Feature> features) const {
  const std::vector<Descriptor> seen = describe_all(left, features);
  Place best;
  for (auto keyframe = keyframes_.rbegin(); keyframe != keyframes_.rend(); ++keyframe) {
    std::vector<Match> matches;
    for (std::size_t i = 0; i < features.size(); ++i) {
      const Alike alike = most_alike(seen[i], keyframe->descriptors);
      if (!alike.clear || most_alike(keyframe->descriptors[alike.index], seen).index != i) continue;
      const Feature& f = features[i];
      matches.push_back({.id = f.id,
                         .seen = {f.left.x(), f.left.y(), f.disparity.value_or(0)},
                         .both_eyes = f.disparity.has_value(),
                         .landmark = keyframe->landmarks[alike.index]});
    }
    if (matches.size() >= kLeastMatches && matches.size() > best.matches.size())
      best = {keyframe->T_odom_base, std::move(matches)};
  }
  return best;
}

}  // namespace cairn::visual_odometry
