// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/saved_state.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::app {
namespace {

SavedState random_state(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vector6::NullaryExpr([&] { return normal(random); }).eval(); };
  SavedState s;
  s.sequence = random();
  s.epoch = static_cast<std::uint32_t>(random());
  s.boot = "5f1c-0a";
  s.stamp = Time{Duration{static_cast<std::int64_t>(random()) * 1'000'003}};
  s.T_odom_base.mean = SE3::exp(vector());
  const Vector6 v = vector();
  s.T_odom_base.covariance = v * v.transpose() + Matrix6::Identity();
  s.twist = vector();
  return s;
}

TEST(SavedState, ParseIsTheInverseOfToText) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const SavedState s = random_state(seed);
    const auto back = parse_state(to_text(s));
    ASSERT_TRUE(back) << to_string(back.error()) << to_text(s);
    EXPECT_EQ(back->sequence, s.sequence);
    EXPECT_EQ(back->epoch, s.epoch);
    EXPECT_EQ(back->boot, s.boot);
    EXPECT_EQ(back->stamp, s.stamp);
    EXPECT_EQ(back->twist, s.twist);
    EXPECT_EQ(back->T_odom_base.covariance, s.T_odom_base.covariance);
    EXPECT_EQ(back->T_odom_base.mean.translation(), s.T_odom_base.mean.translation());
    EXPECT_LT(rotation_angle(back->T_odom_base.mean.inverse() * s.T_odom_base.mean), 1e-15);
    EXPECT_LT(to_text(s).size(), 1536U);
  }
}

TEST(SavedState, CutAnywhereItIsNone) {
  const std::string text = to_text(random_state(1));
  for (std::size_t n = 0; n < text.size(); ++n) EXPECT_FALSE(parse_state(text.substr(0, n)));
  EXPECT_FALSE(parse_state(text + "\n"));
}

TEST(SavedState, NamesTheLineThatIsWrong) {
  const std::string text = to_text(random_state(2));
  const auto with = [&](std::string_view from, std::string_view to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    const auto parsed = parse_state(changed);
    return parsed ? std::string("none") : parsed.error().detail;
  };
  EXPECT_EQ(with("epoch ", "epoch -"), "line epoch");
  EXPECT_EQ(with("boot 5f1c", "boot 5f\xff"), "line boot");
  EXPECT_EQ(with("twist ", "twist nan "), "line twist");
  EXPECT_EQ(with("pose ", "pose inf "), "line pose");
  EXPECT_EQ(with("pose ", "pose 1 "), "line pose");
  EXPECT_EQ(with("cairn-state 1", "cairn-state 2"), "line cairn-state 1");
}

TEST(SavedState, AQuaternionOfAnotherLengthIsNone) {
  EXPECT_FALSE(
      parse_state("cairn-state 1\nsequence 1\nepoch 1\nboot a\nstamp_ns 1\npose 0 0 0 0 0 0 0.5\ntwist 0 0 0 0 "
                  "0 0\ncovariance 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n"));
}

}  // namespace
}  // namespace cairn::app
