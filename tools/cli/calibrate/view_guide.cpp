// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/view_guide.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "drivers/camera/camera.hpp"
#include "hal/clock.hpp"
#include "onboard/perception/calibration/coverage.hpp"
#include "onboard/perception/calibration/eyes_problem.hpp"

namespace cairn::cli {
namespace {

constexpr std::size_t kMostKept = 200;
constexpr double kUsualFocal = 0.8;  // of the picture's width: near enough to tell how a board is tilted

}  // namespace

bool ViewGuide::look(const ImageView& picture) {
  if (views_.size() == kMostKept) return false;
  auto corners = calibration::find_corners(picture, board_, inverted_);
  if (!corners) return false;
  views_.push_back(*std::move(corners));
  const auto chosen = calibration::select_views(board_, views_, picture.width, picture.height, views_.size());
  if (chosen.size() < views_.size()) {
    views_.pop_back();  // it is like one of the others
    return false;
  }
  find_missing(picture.width, picture.height);
  return true;
}

void ViewGuide::find_missing(int width, int height) {
  const cameras::CameraParameters lens{.width = width,
                                       .height = height,
                                       .fx = kUsualFocal * width,
                                       .fy = kUsualFocal * width,
                                       .cx = 0.5 * (width - 1),
                                       .cy = 0.5 * (height - 1),
                                       .distortion = {}};
  std::vector<SE3> T_optical_board;
  for (const calibration::Corners& view : views_)
    if (const auto T = calibration::board_pose(lens, board_, view)) T_optical_board.push_back(*T);
  missing_ = calibration::coverage(views_, T_optical_board, width, height).missing();
}

std::string ViewGuide::text() const {
  std::string text = fmt::format("{} views of the board; ", views_.size());
  if (missing_.empty()) return text + "nothing is missing";
  text += fmt::format("{} kinds are missing, next: {}", missing_.size(), missing_.front());
  return text;
}

Result<Poll> GuidedSource::next(Packet& packet, Duration timeout) {
  const auto poll = source_.next(packet, timeout);
  if (!poll || *poll != Poll::kPacket || packet.source != camera_ || packet.arrival < due_) return poll;
  const Duration before = thread_cpu_time();
  show(packet);
  due_ = packet.arrival + std::max(kPace, kShare * (thread_cpu_time() - before));
  return poll;
}

void GuidedSource::show(const Packet& packet) {
  const auto picture = decode_(packet);
  if (!picture || *picture == nullptr) return;  // the report of the recording counts what was damaged
  ImageView eye = (*picture)->view();
  if (side_by_side_) {
    const auto both = camera::split_side_by_side(eye);
    if (!both) return;
    eye = both->left;
  }
  if (guide_.look(eye)) on_view_();
}

}  // namespace cairn::cli
