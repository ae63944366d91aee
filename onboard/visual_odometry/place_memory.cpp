// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/place_memory.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "onboard/perception/stereo/as_mat.hpp"

namespace cairn::visual_odometry {
namespace {

constexpr int kReach_px = 15;      // of a patch around its pixel
constexpr int kSmooth_px = 9;      // edge of the box that smooths the picture first, as BRIEF's authors have it
constexpr int kFarthest = 40;      // of 256 bits that may differ
constexpr double kClearer = 0.85;  // the best match differs by so much less than the second
constexpr std::size_t kLeastMatches = 15;

struct Comparison {
  int ax, ay, bx, by;
};

/// Places within the patch, denser in the middle; the same in every program.
std::array<Comparison, 256> comparisons() {
  std::uint32_t state = 20100905;
  const auto coordinate = [&state] {
    int sum = 0;  // of four uniform numbers: nearly normal
    for (int i = 0; i < 4; ++i) {
      state = state * 1664525U + 1013904223U;  // Knuth's, by Press et al., Numerical Recipes
      sum += static_cast<int>(state >> 24U);
    }
    return std::clamp((sum - 510) * kReach_px / 400, -kReach_px, kReach_px);
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

Descriptor describe_one(const cv::Mat& smooth, const Eigen::Vector2f& pixel) {
  static const std::array<Comparison, 256> all = comparisons();
  const auto at = [&smooth](int x, int y) {
    return smooth.at<unsigned char>(std::clamp(y, 0, smooth.rows - 1), std::clamp(x, 0, smooth.cols - 1));
  };
  const auto x = static_cast<int>(std::lround(pixel.x())), y = static_cast<int>(std::lround(pixel.y()));
  Descriptor descriptor{};
  for (std::size_t i = 0; i < all.size(); ++i)
    if (at(x + all[i].ax, y + all[i].ay) < at(x + all[i].bx, y + all[i].by))
      descriptor[i / 64] |= std::uint64_t{1} << (i % 64);
  return descriptor;
}

std::vector<Eigen::Vector2f> pixels_of(std::span<const Feature> features) {
  std::vector<Eigen::Vector2f> pixels;
  for (const Feature& f : features) pixels.push_back(f.left);
  return pixels;
}

/// The index of the one that looks like it, if it is clear which; otherwise −1.
int most_alike(const Descriptor& wanted, std::span<const Descriptor> all) {
  int best = 257, second = 257, index = -1;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int bits = differing_bits(wanted, all[i]);
    if (bits < best) {
      second = best;
      best = bits;
      index = static_cast<int>(i);
    } else {
      second = std::min(second, bits);
    }
  }
  return best <= kFarthest && best < kClearer * second ? index : -1;
}

}  // namespace

std::vector<Descriptor> describe(const Image& picture, std::span<const Eigen::Vector2f> pixels) {
  cv::Mat smooth;
  cv::boxFilter(stereo::as_mat(picture), smooth, CV_8U, {kSmooth_px, kSmooth_px});
  std::vector<Descriptor> descriptors;
  for (const Eigen::Vector2f& pixel : pixels) descriptors.push_back(describe_one(smooth, pixel));
  return descriptors;
}

void PlaceMemory::remember(const Image& left, std::span<const Feature> features, const LandmarkMap& landmarks,
                           const SE3& T_odom_base) {
  Keyframe keyframe;
  keyframe.T_odom_base = T_odom_base;
  std::vector<Eigen::Vector2f> pixels;
  for (const Feature& f : features)
    if (const Landmark* landmark = landmarks.find(f.id)) {
      pixels.push_back(f.left);
      keyframe.landmarks.push_back(*landmark);
    }
  keyframe.descriptors = describe(left, pixels);
  keyframes_.push_back(std::move(keyframe));
  if (keyframes_.size() > kPlaces) keyframes_.pop_front();
}

PlaceMemory::Place PlaceMemory::recall(const Image& left, std::span<const Feature> features) const {
  const std::vector<Descriptor> seen = describe(left, pixels_of(features));
  Place best;
  for (auto keyframe = keyframes_.rbegin(); keyframe != keyframes_.rend(); ++keyframe) {
    std::vector<Match> matches;
    for (std::size_t i = 0; i < features.size(); ++i) {
      const int index = most_alike(seen[i], keyframe->descriptors);
      if (index < 0) continue;
      const Feature& f = features[i];
      matches.push_back({.id = f.id,
                         .seen = {f.left.x(), f.left.y(), f.disparity.value_or(0)},
                         .both_eyes = f.disparity.has_value(),
                         .landmark = keyframe->landmarks[static_cast<std::size_t>(index)]});
    }
    if (matches.size() >= kLeastMatches && matches.size() > best.matches.size())
      best = {keyframe->T_odom_base, std::move(matches)};
  }
  return best;
}

}  // namespace cairn::visual_odometry
