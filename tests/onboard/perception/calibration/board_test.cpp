// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/board.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/perception/calibration/boards.hpp"

namespace cairn::calibration {
namespace {

using test::kBoard;

TEST(CalibrationBoard, SizesAreReadAndBounded) {
  const auto board = parse_board("7x5", 0.1);
  ASSERT_TRUE(board);
  EXPECT_EQ(board->columns, 7);
  EXPECT_EQ(board->rows, 5);
  EXPECT_EQ(board->corners(), 35U);
  EXPECT_NEAR((board->corner(34) - Eigen::Vector3d(0.6, 0.4, 0)).norm(), 0, 1e-12);
  for (const char* text : {"", "x", "9", "9x", "2x9", "9x51", "9x6x", "-9x6", "9 x 6", "99999999999x6"})
    EXPECT_FALSE(parse_board(text, 0.1)) << text;
}

TEST(CalibrationBoard, CornersOfAPaintedBoardAreFoundToATenthOfAPixel) {
  const auto camera = *cameras::CameraModel::create(test::small_camera());
  const test::BoardPainter painter(camera, 3);
  std::mt19937 random(3);
  for (const bool inverted : {false, true}) {
    const SE3 T = test::board_at(kBoard, {0.02, -0.01, 0.3}, {0.4, -0.3, 0.1});
    const Image image = inverted ? painter.paint(kBoard, T, 2, random, 200, 50) : painter.paint(kBoard, T, 2, random);
    auto found = find_corners(image.view(), kBoard, inverted);
    ASSERT_TRUE(found) << inverted;
    const auto truth = *test::seen_corners(camera, kBoard, T, 0, random);
    found = ordered_like(truth, *found);
    double squares = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) squares += ((*found)[i] - truth[i]).squaredNorm();
    EXPECT_LT(std::sqrt(squares / (2.0 * static_cast<double>(truth.size()))), 0.1) << "along one axis";
  }
}

TEST(CalibrationBoard, APictureWithoutTheBoardHasNoCorners) {
  Image image;
  image.resize(PixelFormat::kMono8, 64, 48);
  EXPECT_FALSE(find_corners(image.view(), kBoard));
  image.resize(PixelFormat::kMono8, 3, 2);
  EXPECT_FALSE(find_corners(image.view(), kBoard));
  EXPECT_FALSE(find_corners(ImageView{}, kBoard));
  image.resize(PixelFormat::kMono16, 64, 48);
  EXPECT_FALSE(find_corners(image.view(), kBoard));
}

}  // namespace
}  // namespace cairn::calibration
