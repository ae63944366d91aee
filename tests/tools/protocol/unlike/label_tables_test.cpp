// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/unlike/label_tables.hpp"

#include <gtest/gtest.h>

namespace cairn::protocol {
namespace {

TEST(LabelTables, TheBooksClassesAndProbabilitiesToTheThirdDecimal) {
  const auto rows = fused_label_rows();
  ASSERT_EQ(rows.size(), 6U);
  for (const FusedLabelRow& row : rows) {
    EXPECT_EQ(row.class_id, row.book.fused_class) << row.book.table;
    ASSERT_TRUE(row.share) << row.book.table << ' ' << row.book.fused_p;
    EXPECT_GT(*row.share, 0);
    EXPECT_LT(*row.share, 1);
    EXPECT_TRUE(same_to_third_decimal(row.with_share, row.book.fused_p)) << row.with_share;
  }
}

TEST(LabelTables, TheBooksNumbersNeedARestThatIsNotSpreadEvenly) {
  for (const FusedLabelRow& row : fused_label_rows()) {
    EXPECT_FALSE(same_to_third_decimal(row.evenly, row.book.fused_p));
    EXPECT_NEAR(row.evenly, row.book.fused_p, row.book.class_1 == row.book.class_2 ? 0.15 : 0.051);
  }
}

TEST(LabelTables, BayesOverAllClassesAtOnceCannotGiveTable74) {
  for (const FusedLabelRow& row : fused_label_rows()) {
    ASSERT_EQ(row.least_categorical.has_value(), row.book.table == "7.4");
    EXPECT_GT(row.least_categorical.value_or(2), row.book.fused_p + 0.04);
  }
}

TEST(LabelTables, WhatNoShareGivesIsSaid) {
  const FusedLabelRow row = fused_label_row({"none", kRoad, .9, kRoad, .9, kRoad, .999});
  EXPECT_FALSE(row.share);
  EXPECT_EQ(row.with_share, 0);
}

TEST(LabelTables, TheThirdDecimalIsThatOfTheRoundedNumber) {
  EXPECT_TRUE(same_to_third_decimal(0.89449, 0.894));
  EXPECT_FALSE(same_to_third_decimal(0.8951, 0.894));
}

}  // namespace
}  // namespace cairn::protocol
