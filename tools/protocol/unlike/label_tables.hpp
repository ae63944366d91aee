// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/protocol/pairs/book.hpp"

namespace cairn::protocol {

/// A row of the book's Tables 7.3 and 7.4 by merging::fuse_labels(). The book prints one probability of 19 for each
/// robot and leaves out how the rest is spread over the other classes. The fused probability depends on it.
struct FusedLabelRow {
  BookLabels book;
  unsigned class_id = 0;  ///< that the rule gives, with the rest spread evenly
  double evenly = 0;      ///< probability of the book's class with the rest spread evenly
  /// The share of the rest with which the rule gives the book's number; none: with no share. In Table 7.3 it is robot
  /// 2's rest, and the share is that of robot 1's class. In Table 7.4 it is both robots' rest, and the share is that of
  /// one and the same third class.
  std::optional<double> share;
  double with_share = 0;  ///< what the rule gives then
  /// The least that Bayes' rule over all classes at once can give: p₁p₂ over the sum of products. None where it can
  /// give anything.
  std::optional<double> least_categorical;
};
[[nodiscard]] FusedLabelRow fused_label_row(const BookLabels& book);

/// All rows of both tables.
[[nodiscard]] std::vector<FusedLabelRow> fused_label_rows();

/// Whether two probabilities are the same to the third decimal.
[[nodiscard]] bool same_to_third_decimal(double p, double printed);

}  // namespace cairn::protocol
