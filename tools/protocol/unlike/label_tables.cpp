// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/unlike/label_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fusion/merging/labels.hpp"

namespace cairn::protocol {
namespace {

using merging::ClassProbabilities;

constexpr double kEven = 1.0 / (merging::kClasses - 1);  // of the rest, for each other class

/// `p` for a class, `share` of the rest for the rival, and what is left spread evenly.
ClassProbabilities opinion(unsigned class_id, double p, unsigned rival, double share) {
  ClassProbabilities all;
  all.fill((1 - p) * (1 - share) / (merging::kClasses - 2));
  all.at(rival) = (1 - p) * share;
  all.at(class_id) = p;
  return all;
}

ClassProbabilities fused(const BookLabels& book, double share) {
  constexpr unsigned kThird = 1;  // any class but the two
  const bool agree = book.class_1 == book.class_2;
  const std::array opinions{
      opinion(book.class_1, book.p_1, agree ? kThird : book.class_2, agree ? share : kEven),
      opinion(book.class_2, book.p_2, agree ? kThird : book.class_1, share),
  };
  return merging::fuse_labels(opinions);
}

/// By bisection: the more of the rest stands on the rival, the less is left for the fused class.
std::optional<double> share_for(const BookLabels& book) {
  double least = 0, most = 1;
  if (fused(book, least).at(book.fused_class) < book.fused_p || fused(book, most).at(book.fused_class) > book.fused_p)
    return std::nullopt;
  for (int i = 0; i < 50; ++i) {
    const double share = (least + most) / 2;
    (fused(book, share).at(book.fused_class) > book.fused_p ? least : most) = share;
  }
  return least;
}

}  // namespace

FusedLabelRow fused_label_row(const BookLabels& book) {
  const ClassProbabilities evenly = fused(book, kEven);
  FusedLabelRow row{.book = book,
                    .class_id = static_cast<unsigned>(std::ranges::max_element(evenly) - evenly.begin()),
                    .evenly = evenly.at(book.fused_class),
                    .share = share_for(book),
                    .least_categorical = {}};
  if (row.share) row.with_share = fused(book, *row.share).at(book.fused_class);
  const double both = book.p_1 * book.p_2;
  if (book.class_1 == book.class_2) row.least_categorical = both / (both + (1 - book.p_1) * (1 - book.p_2));
  return row;
}

std::vector<FusedLabelRow> fused_label_rows() {
  std::vector<FusedLabelRow> rows;
  for (const BookLabels& book : kBookLabels) rows.push_back(fused_label_row(book));
  return rows;
}

bool same_to_third_decimal(double p, double printed) { return std::lround(1000 * p) == std::lround(1000 * printed); }

}  // namespace cairn::protocol
