// SPDX-License-Identifier: Apache-2.0
// How well landmarks that a LiDAR has measured stay on the corners that visual odometry follows in one camera.
//   lidar_landmarks RECORDING [CONFIG]     for recordings with a LiDAR and a camera: `import kitti-raw` makes some
// A corner gets its distance from the scan of the picture in which it is found. Later pictures follow it by what it
// looks like. Two reprojections are compared with where it is found then: from where the LiDAR's odometry says the
// robot is, and from the pose that the landmarks themselves give, by PoseSolver with one eye. As in visual odometry, a
// landmark that does not fit that pose is dropped: it is on something that moves, or its distance is wrong. The
// sighting for which it is dropped counts, except in its first picture.
#include <Eigen/LU>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/odometry/motion_prior.hpp"
#include "onboard/visual_odometry/pose_solver.hpp"
#include "tests/bench/flights/recorded_flight.hpp"
#include "tools/cli/projection/paired_pictures.hpp"

namespace cairn::visual_odometry {
namespace {

using flights::percentile;

constexpr float kNear_px = 4;         // points that tell a corner's distance are so near to it
constexpr double kOneSurface = 0.03;  // they lie on one surface if their distances differ by less than this share

template <class T>
T value_of(Result<T> result) {
  if (result) return *std::move(result);
  std::fprintf(stderr, "lidar_landmarks: %s\n", to_string(result.error()).c_str());
  std::exit(2);
}

/// The points of a scan where a picture shows them.
class Depths {
 public:
  Depths(const stereo::StereoGeometry& geometry, const SE3& T_eye_base, std::span<const Eigen::Vector3f> points_base) {
    for (const Eigen::Vector3f& p : points_base) {
      const Eigen::Vector3d in_eye = T_eye_base * p.cast<double>();
      if (in_eye.z() < 0.5) continue;
      const Eigen::Vector2f px = geometry.project(in_eye).head<2>().cast<float>();
      if (px.x() >= 0 && px.y() >= 0 && px.x() < 32'000 && px.y() < 32'000)
        cells_[cell(px)].emplace_back(px, in_eye.z());
    }
  }
  /// Along the view, m; none where too few points or an edge are near.
  [[nodiscard]] std::optional<double> at(const Eigen::Vector2f& px) const {
    double weight = 0, inverse = 0, least = 1e9, most = 0;
    int points = 0;
    for (const float dx : {-kNear_px, 0.0F, kNear_px})
      for (const float dy : {-kNear_px, 0.0F, kNear_px}) {
        const auto found = cells_.find(cell(px + Eigen::Vector2f(dx, dy)));
        if (found == cells_.end()) continue;
        for (const auto& [at, depth] : found->second) {
          const double off = (at - px).norm();
          if (off > kNear_px) continue;
          ++points;
          least = std::min(least, depth), most = std::max(most, depth);
          weight += 1 / (off + 0.5), inverse += 1 / (off + 0.5) / depth;
        }
      }
    if (points < 2 || most > (1 + kOneSurface) * least) return std::nullopt;
    return weight / inverse;
  }

 private:
  static std::pair<int, int> cell(const Eigen::Vector2f& px) {
    return {static_cast<int>(px.x() / kNear_px), static_cast<int>(px.y() / kNear_px)};
  }
  std::map<std::pair<int, int>, std::vector<std::pair<Eigen::Vector2f, double>>> cells_;
};

struct Track {
  Landmark landmark;
  int pictures = 0;  // since the landmark was made
};

class OneEye {
 public:
  OneEye(const stereo::Rectifier& rectifier, const SE3& T_base_eye)
      : rectifier_(rectifier),
        geometry_(rectifier.geometry()),
        T_base_eye_(T_base_eye),
        tracker_(config_.tracking, geometry_),
        solver_(config_, geometry_, T_base_eye) {}

  void look(const cli::PicturePair& p) {
    if (pictures_ > 0 && p.scan.epoch != epoch_) tracks_.clear();
    epoch_ = p.scan.epoch;
    cv::Mat both(geometry_.height, 2 * geometry_.width, CV_8UC3, cv::Scalar::all(0));
    std::vector<std::uint8_t> bytes = bytes_of(p.picture);
    const cv::Mat left(p.picture.height, p.picture.width, CV_8UC3, bytes.data());
    left.copyTo(both(cv::Rect(0, 0, left.cols, left.rows)));
    if (!rectifier_.rectify(flights::image_of(both, p.picture.stamp.time_since_epoch().count()), pair_)) return;
    const SE3 T_eye_odom = (p.T_odom_base * T_base_eye_).inverse();
    tracker_.follow(pair_, [&](const Feature& f) -> std::optional<Eigen::Vector3d> {
      const auto track = tracks_.find(f.id);
      if (track == tracks_.end()) return std::nullopt;
      const Eigen::Vector3d in_eye = T_eye_odom * track->second.landmark.p_odom;
      return in_eye.z() > 0.1 ? std::optional(geometry_.project(in_eye)) : std::nullopt;
    });
    compare(p);
    tracker_.add_corners();
    begin_landmarks(p);
    ++pictures_;
  }

  void print() const {
    std::printf("%d pictures, %zu landmarks were seen again; %zu did not fit at once, %zu later; %zu sightings fit\n",
                pictures_, seen_again_, left_out_, dropped_, kept_);
    const auto row = [](const char* name, const std::vector<double>& px) {
      std::printf("%-38s median %.2f px, 75 %% %.2f px, 95 %% %.2f px, of %zu\n", name, percentile(px, 0.5),
                  percentile(px, 0.75), percentile(px, 0.95), px.size());
    };
    row("from the LiDAR's odometry", by_lidar_);
    row("from the pose of one eye", by_eye_);
    row("from the LiDAR's odometry, after 10", old_by_lidar_);
    row("from the pose of one eye, after 10", old_by_eye_);
    std::printf("poses of one eye beside the LiDAR's: median %.3f m, %.3f deg\n", percentile(apart_m_, 0.5),
                percentile(apart_deg_, 0.5));
  }

 private:
  /// A copy: cv::Mat knows no const data.
  static std::vector<std::uint8_t> bytes_of(const Image& picture) {
    std::vector<std::uint8_t> bytes(picture.bytes.size());
    std::memcpy(bytes.data(), picture.bytes.data(), bytes.size());
    return bytes;
  }

  void compare(const cli::PicturePair& p) {
    std::vector<Match> matches;
    std::map<std::uint32_t, Track> kept;
    for (const Feature& f : tracker_.features()) {
      const auto track = tracks_.find(f.id);
      if (track == tracks_.end()) continue;
      seen_again_ += track->second.pictures++ == 0 ? 1 : 0;
      kept.insert(*track);
      matches.push_back(
          {.id = f.id, .seen = {f.left.x(), f.left.y(), 0}, .both_eyes = false, .landmark = track->second.landmark});
    }
    tracks_ = std::move(kept);
    if (matches.size() < 10) return;
    const Fit fit = solved(matches, p.T_odom_base);
    const SE3& by_eye = fit.state.T_odom_base;
    std::set<std::uint32_t> dropped;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      const Match& m = matches[i];
      const bool first = tracks_.at(m.id).pictures == 1, fits = fit.fits[i] != 0;
      if (!fits) dropped.insert(m.id);
      ++(fits ? kept_ : first ? left_out_ : dropped_);
      if (first && !fits) continue;
      const bool old = tracks_.at(m.id).pictures > 10;
      add(m, p.T_odom_base, by_lidar_, old ? &old_by_lidar_ : nullptr);
      add(m, by_eye, by_eye_, old ? &old_by_eye_ : nullptr);
    }
    for (const std::uint32_t id : dropped) tracks_.erase(id);
    tracker_.drop([&](const Feature& f) { return dropped.contains(f.id); });
    const SE3 apart = p.T_odom_base.inverse() * by_eye;
    apart_m_.push_back(apart.translation().norm());
    apart_deg_.push_back(rotation_angle(apart) * 180 / std::numbers::pi);
  }

  /// With a prior of 0.1 m and 1.1° around the LiDAR's odometry.
  [[nodiscard]] Fit solved(const std::vector<Match>& matches, const SE3& near) const {
    odometry::MotionFilter filter;
    odometry::MotionFilter::Uncertainty wide;
    wide.local.diagonal().head<6>() << 0.01, 0.01, 0.01, 4e-4, 4e-4, 4e-4;
    wide.local.diagonal().tail<6>().setConstant(1);
    wide.total = wide.local;
    filter.reset({near, Vector6::Zero()}, wide);
    Budget budget = Budget::steps(most_steps_);
    return solver_.align(matches, filter, filter.state(), budget);
  }

  void add(const Match& m, const SE3& T_odom_base, std::vector<double>& all, std::vector<double>* old) const {
    const Eigen::Vector3d in_eye = (T_odom_base * T_base_eye_).inverse() * m.landmark.p_odom;
    const double off = in_eye.z() > 0.1 ? (geometry_.project(in_eye) - m.seen).head<2>().norm() : 1e3;
    all.push_back(off);
    if (old != nullptr) old->push_back(off);
  }

  void begin_landmarks(const cli::PicturePair& p) {
    const SE3 T_odom_eye = p.T_odom_base * T_base_eye_;
    const Depths depths(geometry_, T_odom_eye.inverse() * p.scan.T_odom_base, p.scan.points_base);
    for (const Feature& f : tracker_.features()) {
      if (tracks_.contains(f.id)) continue;
      const auto depth = depths.at(f.left);
      if (!depth) continue;
      const Eigen::Vector3d in_eye((f.left.x() - geometry_.cx) / geometry_.fx * *depth,
                                   (f.left.y() - geometry_.cy) / geometry_.fy * *depth, *depth);
      Track track;
      track.landmark.p_odom = T_odom_eye * in_eye;
      track.landmark.covariance = 1e-4 * Eigen::Matrix3d::Identity();  // 1 cm: a LiDAR's
      tracks_[f.id] = track;
    }
  }

  VisualOdometryConfig config_;
  const stereo::Rectifier& rectifier_;
  stereo::StereoGeometry geometry_;
  SE3 T_base_eye_;
  FeatureTracker tracker_;
  PoseSolver solver_;
  stereo::StereoPair pair_;
  std::map<std::uint32_t, Track> tracks_;
  std::vector<double> by_lidar_, by_eye_, old_by_lidar_, old_by_eye_, apart_m_, apart_deg_;
  std::size_t seen_again_ = 0, left_out_ = 0, dropped_ = 0, kept_ = 0;
  std::uint32_t epoch_ = 0;
  int pictures_ = 0;
  static constexpr int most_steps_ = 100;
};

int run(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: lidar_landmarks RECORDING [CONFIG]\n", stderr);
    return 2;
  }
  const std::filesystem::path recording = argv[1];
  const auto profile = value_of(app::choose_profile(argc > 2 ? argv[2] : "", recording)).profile;
  const auto size = app::picture_size(profile.camera);
  const auto camera = value_of(profile.camera.intrinsics.model(size.width, size.height));
  const auto rectifier = value_of(stereo::Rectifier::create(camera, 1));  // one eye: the baseline says nothing
  const SE3 T_base_camera = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(profile.camera.base_xyz_rpy.data()));
  OneEye eye(rectifier, T_base_camera * cameras::T_camera_optical());
  const auto pairs = value_of(cli::PairedPictures::open(recording, profile));
  const auto done = pairs->for_each(1, [&](const cli::PicturePair& p) -> Result<void> {
    eye.look(p);
    return {};
  });
  if (!done) value_of<int>(done.error());
  eye.print();
  return 0;
}

}  // namespace
}  // namespace cairn::visual_odometry

int main(int argc, char** argv) { return cairn::visual_odometry::run(argc, argv); }
