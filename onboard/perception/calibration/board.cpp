// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/board.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace cairn::calibration {
namespace {

constexpr int kSmall_px = 200, kMiddle_px = 700;  // widths of pictures that are enlarged four times and twice

bool take_number(std::string_view text, int& number) {
  const auto end = text.data() + text.size();
  const auto [stop, fault] = std::from_chars(text.data(), end, number);
  return fault == std::errc() && stop == end && number >= Board::kLeast && number <= Board::kMost;
}

cv::Mat grey(const ImageView& picture, bool inverted) {
  const int type = picture.format == PixelFormat::kBgr8 ? CV_8UC3 : CV_8UC1;
  // OpenCV takes what is not const, and only reads it.
  auto* bytes = const_cast<std::byte*>(picture.bytes.data());  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  const cv::Mat given(picture.height, picture.width, type, bytes, picture.stride);
  cv::Mat out;
  if (type == CV_8UC3)
    cv::cvtColor(given, out, cv::COLOR_BGR2GRAY);
  else
    out = given.clone();
  if (inverted) cv::bitwise_not(out, out);
  return out;
}

/// Finds the corners, to a pixel or so. In small pictures boards are found in an enlarged one only.
std::vector<cv::Point2f> search(const cv::Mat& image, const Board& board) {
  const int factor = image.cols <= kSmall_px ? 4 : image.cols <= kMiddle_px ? 2 : 1;
  cv::Mat large;
  cv::resize(image, large, {}, factor, factor, cv::INTER_LINEAR);
  std::vector<cv::Point2f> found;
  if (!cv::findChessboardCorners(
          large, {board.columns, board.rows}, found,
          cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK) ||
      found.size() != board.corners())
    return {};
  const float scale = 1 / static_cast<float>(factor);
  for (cv::Point2f& p : found) p = {scale * (p.x + 0.5F) - 0.5F, scale * (p.y + 0.5F) - 0.5F};
  return found;
}

/// Half the side of the window that a corner is refined in: it must not reach the next corner.
int refining_window(const std::vector<cv::Point2f>& corners, const Board& board) {
  double nearest = 1e9;
  const auto columns = static_cast<std::size_t>(board.columns);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if ((i + 1) % columns != 0) nearest = std::min(nearest, cv::norm(corners[i] - corners[i + 1]));
    if (i + columns < corners.size()) nearest = std::min(nearest, cv::norm(corners[i] - corners[i + columns]));
  }
  return std::clamp(static_cast<int>(0.4 * nearest), 2, 11);
}

}  // namespace

Eigen::Vector3d Board::corner(std::size_t index) const {
  const auto across = static_cast<std::size_t>(columns);
  return {square_m * static_cast<double>(index % across), square_m * static_cast<double>(index / across), 0};
}

Eigen::Vector3d Board::centre() const { return {0.5 * square_m * (columns - 1), 0.5 * square_m * (rows - 1), 0}; }

double Board::half_diagonal() const { return 0.5 * square_m * std::hypot(columns + 1, rows + 1); }

Result<Board> parse_board(std::string_view text, double square_m) {
  const std::size_t cross = text.find('x');
  Board board{.square_m = square_m};
  if (cross != std::string_view::npos && take_number(text.substr(0, cross), board.columns) &&
      take_number(text.substr(cross + 1), board.rows))
    return board;
  return Error{Errc::kInvalidConfig,
               "not the size of a board",
               "--board",
               {},
               "\"" + std::string(text) + "\": give the inner corners of a row and of a column, 3 to 50, such as 9x6"};
}

std::optional<Corners> find_corners(const ImageView& picture, const Board& board, bool inverted) {
  if (picture.empty() || (picture.format != PixelFormat::kMono8 && picture.format != PixelFormat::kBgr8)) return {};
  std::vector<cv::Point2f> found;
  try {
    const cv::Mat image = grey(picture, inverted);
    found = search(image, board);
    if (found.empty()) return {};
    const int window = refining_window(found, board);
    cv::cornerSubPix(image, found, {window, window}, {-1, -1},
                     {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 1e-3});
  } catch (const cv::Exception&) {
    return {};  // a picture that is too small for its own margins
  }
  Corners corners;
  corners.reserve(found.size());
  for (const cv::Point2f& p : found) corners.emplace_back(p.x, p.y);
  return corners;
}

Corners ordered_like(const Corners& like, Corners corners) {
  const Eigen::Vector2d a = like.back() - like.front(), b = corners.back() - corners.front();
  if (a.dot(b) < 0) std::reverse(corners.begin(), corners.end());
  return corners;
}

}  // namespace cairn::calibration
