// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/feature_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "onboard/perception/stereo/as_mat.hpp"
#include "onboard/visual_odometry/corner_detector.hpp"
#include "onboard/visual_odometry/patch.hpp"

namespace cairn::visual_odometry {
namespace {

constexpr int kSteps = 12;            // of an alignment at most
constexpr double kEnough_px = 0.02;   // a smaller step ends it
constexpr double kLeastEigen = 1e-3;  // of a patch, per pixel: below, it has no structure
constexpr int kBorder_px = 6;         // corners keep away from the edge

cv::Point2f point(const Eigen::Vector2f& p) { return {p.x(), p.y()}; }

struct Alignment {
  std::vector<cv::Point2f> to;
  std::vector<unsigned char> found;
};

/// Where the patches around `from` are in the other picture; `to` is where the search begins.
void align(const std::vector<cv::Mat>& first, const std::vector<cv::Mat>& second, const std::vector<cv::Point2f>& from,
           const TrackingConfig& config, Alignment& result) {
  std::vector<float> errors;
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, kSteps, kEnough_px);
  cv::calcOpticalFlowPyrLK(first, second, from, result.to, result.found, errors,
                           cv::Size(config.window_px, config.window_px), config.levels, until,
                           cv::OPTFLOW_USE_INITIAL_FLOW, kLeastEigen);
}

/// 255 where a corner may be added.
cv::Mat free_places(std::span<const Feature> features, const cv::Size& size, int spacing_px) {
  cv::Mat mask(size, CV_8UC1, cv::Scalar(0));
  const cv::Rect inner(kBorder_px, kBorder_px, size.width - 2 * kBorder_px, size.height - 2 * kBorder_px);
  mask(inner).setTo(255);
  for (const Feature& f : features) cv::circle(mask, point(f.left), spacing_px, cv::Scalar(0), cv::FILLED);
  return mask;
}

}  // namespace

struct FeatureTracker::Pictures {
  std::vector<cv::Mat> before, left, right;  // pyramids
  CornerDetector detector;
};

FeatureTracker::FeatureTracker(const TrackingConfig& config, const stereo::StereoGeometry& geometry)
    : config_(config), geometry_(geometry), pictures_(std::make_unique<Pictures>()) {}
FeatureTracker::FeatureTracker(FeatureTracker&&) noexcept = default;
FeatureTracker& FeatureTracker::operator=(FeatureTracker&&) noexcept = default;
FeatureTracker::~FeatureTracker() = default;

void FeatureTracker::follow(const stereo::StereoPair& pair, const Expected& expected) {
  const cv::Size window(config_.window_px, config_.window_px);
  std::swap(pictures_->before, pictures_->left);
  features_before_ = features_;
  cv::buildOpticalFlowPyramid(stereo::as_mat(pair.left), pictures_->left, window, config_.levels);
  cv::buildOpticalFlowPyramid(stereo::as_mat(pair.right), pictures_->right, window, config_.levels);
  if (features_.empty()) return;
  std::vector<cv::Point2f> from;
  Alignment now;
  for (const Feature& f : features_) {
    from.push_back(point(f.left));
    const auto place = expected(f);
    now.to.push_back(place ? cv::Point2f(static_cast<float>(place->x()), static_cast<float>(place->y())) : from.back());
  }
  align(pictures_->before, pictures_->left, from, config_, now);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < features_.size(); ++i) {
    const cv::Point2f& p = now.to[i];
    const bool inside = p.x >= kBorder_px && p.y >= kBorder_px &&
                        p.x < static_cast<float>(geometry_.width - kBorder_px) &&
                        p.y < static_cast<float>(geometry_.height - kBorder_px);
    if (now.found[i] == 0 || !inside) continue;
    features_[kept] = features_[i];
    features_[kept++].left = {p.x, p.y};
  }
  features_.resize(kept);
  for (Feature& f : features_) anchor(f);
  match_eyes(features_, expected);
}

/// Puts a feature to where its patch is in the left eye. One whose patch is not found, or has none, gets that of this
/// picture.
void FeatureTracker::anchor(Feature& f) const {
  const cv::Mat& left = pictures_->left[0];
  if (const auto found = f.patch ? f.patch->find(left, {f.left, f.warp_left}) : std::nullopt) {
    f.left = found->middle;
    f.warp_left = found->warp;
    return;
  }
  const auto patch = Patch::cut(left, f.left);
  f.patch = patch ? std::make_shared<const Patch>(*patch) : nullptr;
  f.warp_left.setIdentity();
  f.warp_right.setIdentity();
}

/// Looks for a feature's patch in the right eye. False, and nothing has changed, where it is not near `disparity`.
bool FeatureTracker::find_right(Feature& f, float disparity) const {
  if (!f.patch) return false;
  const auto found = f.patch->find(pictures_->right[0], {{f.left.x() - disparity, f.left.y()}, f.warp_right});
  if (!found || !fits(f, found->middle)) return false;
  f.disparity = f.left.x() - found->middle.x();
  f.warp_right = found->warp;
  return true;
}

/// Whether the right eye can show the feature there.
bool FeatureTracker::fits(const Feature& f, const Eigen::Vector2f& right) const {
  return std::abs(f.left.y() - right.y()) < static_cast<float>(config_.max_row_error_px) && right.x() < f.left.x() &&
         right.x() > kBorder_px;
}

/// By the patches where it is known what to expect. The others are followed from eye to eye first.
void FeatureTracker::match_eyes(std::span<Feature> features, const Expected& expected) const {
  std::vector<Feature*> unsure;
  std::vector<cv::Point2f> from;
  Alignment right;
  for (Feature& f : features) {
    const auto place = expected(f);
    if (place && find_right(f, static_cast<float>(place->z()))) continue;
    const auto disparity = place ? static_cast<float>(place->z()) : f.disparity.value_or(0.0F);
    unsure.push_back(&f);
    from.push_back(point(f.left));
    right.to.emplace_back(f.left.x() - disparity, f.left.y());
  }
  if (unsure.empty()) return;
  align(pictures_->left, pictures_->right, from, config_, right);
  for (std::size_t i = 0; i < unsure.size(); ++i) {
    Feature& f = *unsure[i];
    const Eigen::Vector2f to(right.to[i].x, right.to[i].y);
    f.disparity = right.found[i] != 0 && fits(f, to) ? std::optional(f.left.x() - to.x()) : std::nullopt;
    if (f.disparity) find_right(f, *f.disparity);
  }
}

void FeatureTracker::drop(const std::function<bool(const Feature&)>& unwanted) { std::erase_if(features_, unwanted); }

void FeatureTracker::reject() {
  std::swap(pictures_->before, pictures_->left);
  features_ = features_before_;
}

void FeatureTracker::add_corners() {
  for (const Feature& corner : corners_between(features_)) features_.push_back(corner);
}

std::vector<Feature> FeatureTracker::fresh_corners() { return corners_between({}); }

std::vector<Feature> FeatureTracker::corners_between(std::span<const Feature> others) {
  std::vector<Feature> corners;
  const int room = config_.features - static_cast<int>(others.size());
  if (room <= 0 || pictures_->left.empty()) return corners;
  const cv::Mat& picture = pictures_->left[0];
  const cv::Mat places = free_places(others, picture.size(), config_.spacing_px);
  for (const cv::Point2f p : pictures_->detector.find(picture, places, {room, config_.spacing_px, config_.quality}))
    corners.push_back({next_id_++, {p.x, p.y}, std::nullopt, nullptr});
  for (Feature& f : corners) anchor(f);
  match_eyes(corners, [](const Feature&) { return std::nullopt; });
  return corners;
}

}  // namespace cairn::visual_odometry
