// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/mount/picture_tracker.hpp"

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <utility>

#include "onboard/perception/stereo/as_mat.hpp"
#include "onboard/visual_odometry/corner_detector.hpp"

namespace cairn::mount {
namespace {

constexpr int kSteps = 12;            // of an alignment at most
constexpr double kEnough_px = 0.02;   // a smaller step ends it
constexpr double kLeastEigen = 1e-3;  // of a patch, per pixel: below, it has no structure
constexpr int kBorder_px = 6;         // corners keep away from the edge

using Points = std::vector<cv::Point2f>;

cv::Point2f point(const Eigen::Vector2d& p) { return {static_cast<float>(p.x()), static_cast<float>(p.y())}; }
Eigen::Vector2d pixel(const cv::Point2f& p) { return {p.x, p.y}; }

/// Where the patches around `from` are in the other picture; `to` is where the search begins.
std::vector<unsigned char> align(const std::vector<cv::Mat>& first, const std::vector<cv::Mat>& second,
                                 const Points& from, Points& to, const TrackerConfig& config) {
  std::vector<unsigned char> found;
  std::vector<float> errors;
  if (from.empty()) return found;
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, kSteps, kEnough_px);
  cv::calcOpticalFlowPyrLK(first, second, from, to, found, errors, cv::Size(config.window_px, config.window_px),
                           config.levels, until, cv::OPTFLOW_USE_INITIAL_FLOW, kLeastEigen);
  return found;
}

}  // namespace

struct PictureTracker::Pictures {
  std::vector<cv::Mat> reference, now;  // pyramids
  cv::Mat grey;
  Points corners;  // of the reference
  visual_odometry::CornerDetector detector;

  void take(const Image& picture, const TrackerConfig& config, std::vector<cv::Mat>& pyramid) {
    const cv::Mat given = stereo::as_mat(picture);
    if (picture.format == PixelFormat::kBgr8) cv::cvtColor(given, grey, cv::COLOR_BGR2GRAY);
    cv::buildOpticalFlowPyramid(picture.format == PixelFormat::kBgr8 ? grey : given, pyramid,
                                cv::Size(config.window_px, config.window_px), config.levels);
  }
};

PictureTracker::PictureTracker(const TrackerConfig& config)
    : config_(config), pictures_(std::make_unique<Pictures>()) {}
PictureTracker::PictureTracker(PictureTracker&&) noexcept = default;
PictureTracker& PictureTracker::operator=(PictureTracker&&) noexcept = default;
PictureTracker::~PictureTracker() = default;

std::size_t PictureTracker::corners() const { return pictures_->corners.size(); }

void PictureTracker::refer_to(const Image& picture) {
  pictures_->take(picture, config_, pictures_->reference);
  look_for_corners();
}

void PictureTracker::refer_to_found() {
  std::swap(pictures_->reference, pictures_->now);
  look_for_corners();
}

void PictureTracker::look_for_corners() {
  const cv::Mat& picture = pictures_->reference[0];
  cv::Mat allowed(picture.size(), CV_8UC1, cv::Scalar(0));
  allowed(cv::Rect(kBorder_px, kBorder_px, picture.cols - 2 * kBorder_px, picture.rows - 2 * kBorder_px)).setTo(255);
  pictures_->corners.clear();
  for (const cv::Point& p :
       pictures_->detector.find(picture, allowed, {config_.corners, config_.spacing_px, config_.quality}))
    pictures_->corners.emplace_back(p);
}

std::span<const Match> PictureTracker::find_in(const Image& picture, const Expected& expected) {
  pictures_->take(picture, config_, pictures_->now);
  matches_.clear();
  Points from, to;
  for (const cv::Point2f& p : pictures_->corners)
    if (const auto place = expected(pixel(p))) {
      from.push_back(p);
      to.push_back(point(*place));
    }
  const auto there = align(pictures_->reference, pictures_->now, from, to, config_);
  Points back = from;
  const auto home = align(pictures_->now, pictures_->reference, to, back, config_);
  for (std::size_t i = 0; i < from.size(); ++i)
    if (there[i] != 0 && home[i] != 0 && cv::norm(back[i] - from[i]) <= config_.most_back_px)
      matches_.push_back({pixel(from[i]), pixel(to[i])});
  return matches_;
}

}  // namespace cairn::mount
