// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/motor_bus.hpp"
#include "tools/simulator/scenes/make_world.hpp"

#include <gtest/gtest.h>

#include <set>

#include "drivers/drive/can/candump.hpp"
#include "drivers/drive/wheel_decoder.hpp"
#include "tests/tools/simulator/sensors/scene_with_people.hpp"

namespace cairn::simulator {
namespace {

Trajectory driven(const char* scene, std::uint64_t seed, int for_s) {
  const auto world = make_world(scene);
  const FloorPlan plan(*world);
  const auto paths = RoutePlanner(*world, plan, seed).plan(1, 1.5 * for_s + 2);
  return drive(*world, plan, (*paths)[0], kTestStart, std::chrono::seconds(for_s), {}, seed);
}

/// All frames from the start on.
std::vector<Packet> run(MotorBus& bus, const Trajectory& trajectory) {
  std::vector<Packet> all;
  while (bus.now() < trajectory.end()) {
    bus.tick(bus.now() > trajectory.start() + std::chrono::milliseconds(600));
    for (const Packet& p : bus.frames()) {
      if (p.arrival >= trajectory.start()) all.push_back(p);
    }
  }
  return all;
}

TEST(MotorBus, IsEnabledBeforeTheRobotMovesAndStaysSo) {
  const Trajectory trajectory = driven("lobby", 2, 10);
  MotorBus bus({}, trajectory, 1);
  while (bus.now() < trajectory.end()) {
    bus.tick(bus.now() > trajectory.start() + std::chrono::milliseconds(600));
    if (bus.now() < trajectory.start() + std::chrono::milliseconds(600)) {
      EXPECT_EQ(bus.level(), DriveLevel::kStop);
    }
    if (bus.now() > trajectory.start() + std::chrono::milliseconds(950)) {
      ASSERT_EQ(bus.level(), DriveLevel::kNormal) << to_seconds(bus.now());
    }
  }
}

/// SE(3) distance of the odometry to the truth, in sigmas, as a chi² with three degrees of freedom (x, y, yaw).
double chi2(const DriveState& state, const SE3& truth) {
  const Vector6 error = (state.T_odom_base.mean.inverse() * truth).log();
  const Eigen::Vector3d e(error[0], error[1], error[5]);
  const Matrix6& c = state.T_odom_base.covariance;
  Eigen::Matrix3d s;
  const int at[] = {0, 1, 5};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) s(i, j) = c(at[i], at[j]);
  }
  return e.dot(s.ldlt().solve(e));
}

TEST(MotorBus, OdometryStaysWithinThreeSigmaOfItsOwnCovariance) {
  constexpr double kThreeSigma = 14.16;  // chi² of three degrees of freedom at the probability of 3 σ
  int inside = 0, all = 0, spins = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const Trajectory trajectory = driven("corridor", seed, 40);
    MotorBus bus({}, trajectory, seed);
    const auto decoder = std::move(*drive::WheelDecoder::create(husky_drive()));
    std::optional<SE3> T_world_odom;
    for (const Packet& p : run(bus, trajectory)) {
      const auto state = decoder->decode(p);
      ASSERT_TRUE(state);
      if (*state == nullptr) continue;
      const SE3 T_world_base = trajectory.T_world_base((*state)->stamp);
      if (!T_world_odom) T_world_odom = T_world_base * (*state)->T_odom_base.mean.inverse();
      inside += chi2(**state, T_world_odom->inverse() * T_world_base) < kThreeSigma ? 1 : 0;
      ++all;
    }
    spins += bus.spins();
  }
  RecordProperty("inside_3_sigma_percent", std::to_string(100.0 * inside / all));
  EXPECT_GT(all, 6 * 40 * 80);
  EXPECT_GT(spins, 3);
  EXPECT_GE(inside, 0.95 * all);
  EXPECT_LT(to_seconds(MotorBus::kTick) * all, 6 * 45);
}

TEST(MotorBus, FramesFitOnTheWireAndReadBackFromCandumpText) {
  const Trajectory trajectory = driven("lobby", 2, 4);
  MotorBus bus({}, trajectory, 1);
  std::string text;
  std::vector<drive::CanFrame> sent;
  Time last{};
  std::set<std::uint32_t> ids;
  for (const Packet& p : run(bus, trajectory)) {
    EXPECT_GE(p.arrival - last, std::chrono::microseconds(222));
    last = p.arrival;
    sent.push_back(drive::decode_frame(p.payload()).value());
    ids.insert(sent.back().id);
    drive::append_candump(text, p.arrival, "can0", sent.back());
  }
  for (const std::uint32_t id : {0x080U, 0x181U, 0x182U, 0x201U, 0x202U, 0x281U, 0x282U, 0x701U, 0x702U, 0x77FU}) {
    EXPECT_EQ(ids.count(id), 1U) << std::hex << id;
  }
  std::size_t i = 0;
  for (std::size_t at = 0; at < text.size(); ++i) {
    const std::size_t end = text.find('\n', at);
    const auto line = drive::parse_candump(std::string_view(text).substr(at, end - at));
    ASSERT_TRUE(line && *line);
    EXPECT_EQ((*line)->frame, sent.at(i));
    at = end + 1;
  }
  EXPECT_EQ(i, sent.size());
}

TEST(MotorBus, SameSeedSameFrames) {
  const Trajectory trajectory = driven("lobby", 2, 3);
  const auto bytes = [&](std::uint64_t seed) {
    MotorBus bus({}, trajectory, seed);
    std::vector<std::byte> all;
    for (const Packet& p : run(bus, trajectory)) all.insert(all.end(), p.bytes.begin(), p.bytes.end());
    return all;
  };
  EXPECT_EQ(bytes(1), bytes(1));
  EXPECT_NE(bytes(1), bytes(2));
}

}  // namespace
}  // namespace cairn::simulator
