// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/camera.hpp"

#include <limits>

#include "tests/drivers/clients/messages/message_checks.hpp"

namespace cairn::clients {
namespace {

CameraMessage some_camera() {
  return {.camera = 1,
          .name = "front",
          .width = 672,
          .height = 376,
          .side_by_side = true,
          .lens = CameraMessage::Lens::kRadTan,
          .fx = 350,
          .fy = 351,
          .cx = 336.5,
          .cy = 187.25,
          .k = {0.1, -0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8},
          .baseline_m = 0.12};
}

TEST(CameraMessage, ComesBackAsItWasSent) {
  const CameraMessage sent = some_camera();
  const auto got = decode_camera(test::body_of(sent));
  ASSERT_TRUE(got) << to_string(got.error());
  EXPECT_EQ(got->camera, 1);
  EXPECT_EQ(got->name, "front");
  EXPECT_EQ(got->width, 672U);
  EXPECT_EQ(got->height, 376U);
  EXPECT_TRUE(got->side_by_side);
  EXPECT_EQ(got->lens, CameraMessage::Lens::kRadTan);
  EXPECT_EQ(got->fx, sent.fx);
  EXPECT_EQ(got->cy, sent.cy);
  EXPECT_EQ(got->k, sent.k);
  EXPECT_EQ(got->baseline_m, 0.12);
  test::expect_exact(test::body_of(sent), decode_camera);
}

TEST(CameraMessage, RefusesWhatNoCameraIs) {
  const auto refused = [](auto change) {
    CameraMessage message = some_camera();
    change(message);
    return !decode_camera(test::body_of(message));
  };
  EXPECT_TRUE(refused([](CameraMessage& m) { m.camera = CameraMessage::kMost; }));
  EXPECT_TRUE(refused([](CameraMessage& m) { m.width = CameraMessage::kMaxSide + 1; }));
  EXPECT_TRUE(refused([](CameraMessage& m) { m.fx = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](CameraMessage& m) { m.lens = static_cast<CameraMessage::Lens>(3); }));
}

}  // namespace
}  // namespace cairn::clients
