// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/items/bodies.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace cairn::peers {
namespace {

Bodies some_bodies(std::size_t people) {
  Bodies bodies{
      .epoch = 7, .stamp = Time{Duration{99}}, .age = std::chrono::milliseconds(120), .robot = {}, .people = {}};
  bodies.robot = {.position_m = {1, -2, 0.1}, .velocity_m_s = {0.5, 0}, .radius_m = 0.6, .height_m = 0.9};
  for (std::size_t i = 0; i < people; ++i) {
    Bodies::Person& p = bodies.people.emplace_back();
    p.id = static_cast<std::uint32_t>(3 * i + 1);
    p.position_m = {10.25 + static_cast<double>(i), -3.5, 0.02};
    p.velocity_m_s = {-1.25, 0.75};
    p.covariance << 0.04, 0.01, 0.01, 0.02;
  }
  return bodies;
}

std::vector<std::byte> bytes_for(const Bodies& bodies) {
  std::vector<std::byte> bytes;
  append_bodies(bytes, bodies);
  return bytes;
}

Result<Bodies> bodies_in(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  auto bodies = read_bodies(in);
  if (bodies && in.remaining() != 0) return Error{Errc::kMalformed, "bytes are left"};
  return bodies;
}

TEST(Bodies, ComeBackToACentimetre) {
  const Bodies sent = some_bodies(2);
  const auto got = bodies_in(bytes_for(sent));
  ASSERT_TRUE(got) << to_string(got.error());
  EXPECT_EQ(got->epoch, 7U);
  EXPECT_EQ(got->stamp, sent.stamp);
  EXPECT_EQ(got->age, sent.age);
  EXPECT_LT((got->robot.position_m - sent.robot.position_m).norm(), 0.01);
  EXPECT_NEAR(got->robot.radius_m, 0.6, 1e-9);
  ASSERT_EQ(got->people.size(), 2U);
  EXPECT_EQ(got->people[1].id, 4U);
  EXPECT_LT((got->people[1].position_m - sent.people[1].position_m).norm(), 0.01);
  EXPECT_LT((got->people[1].velocity_m_s - sent.people[1].velocity_m_s).norm(), 0.01);
  EXPECT_LT((got->people[1].covariance - sent.people[1].covariance).norm(), 2e-4);
}

TEST(Bodies, AreSmall) {
  EXPECT_LE(bytes_for(some_bodies(0)).size(), 24U);
  EXPECT_LE(bytes_for(some_bodies(8)).size(), 24U + 8 * 18U);
}

TEST(Bodies, ACrowdIsCutAndFitsADatagram) {
  Bodies crowd = some_bodies(500);
  for (Bodies::Person& p : crowd.people) {
    p.position_m.setConstant(-1e9);
    p.velocity_m_s.setConstant(1e9);
    p.covariance.setConstant(1e9);
  }
  const auto bytes = bytes_for(crowd);
  EXPECT_LT(bytes.size(), 1000U);
  EXPECT_EQ(bodies_in(bytes)->people.size(), Bodies::kMost);
}

TEST(Bodies, WhateverIsSaidCanBeRead) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf, 1e300, -1.0, 0.0}) {
    Bodies bodies = some_bodies(2);
    bodies.robot.position_m.x() = bodies.robot.radius_m = bodies.people[0].velocity_m_s.y() = bad;
    bodies.people[0].covariance.setConstant(bad);
    bodies.people[1].id = 1;  // not in order
    bodies.age = Duration::max();
    const auto got = bodies_in(bytes_for(bodies));
    ASSERT_TRUE(got) << to_string(got.error());
    ASSERT_EQ(got->people.size(), 1U);
    EXPECT_GT(got->people[0].covariance.determinant(), 0);
    EXPECT_EQ(bytes_for(*got), bytes_for(bodies));
  }
}

TEST(Bodies, NoPartOfThemIsAWhole) {
  const auto bytes = bytes_for(some_bodies(3));
  for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(bodies_in(std::span(bytes).first(n))) << n;
}

TEST(Bodies, DamagedOnesAreRefusedOrHaveOneForm) {
  std::mt19937 random(1);
  const auto whole = bytes_for(some_bodies(4));
  for (int i = 0; i < 20000; ++i) {
    auto bytes = whole;
    for (int flips = 0; flips < 3; ++flips) bytes[random() % bytes.size()] = static_cast<std::byte>(random());
    const auto got = bodies_in(bytes);
    if (!got) continue;
    EXPECT_EQ(bytes_for(*got), bytes);
    EXPECT_LE(got->people.size(), Bodies::kMost);
    for (const Bodies::Person& p : got->people) {
      EXPECT_NE(p.id, 0U);
      EXPECT_GT(p.covariance.determinant(), 0);
    }
  }
}

}  // namespace
}  // namespace cairn::peers
