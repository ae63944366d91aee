// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tree/label_evidence.hpp"

#include <algorithm>

namespace cairn::mapping {
namespace {

constexpr unsigned kClasses = VoxelLabel::kClasses, kNames = kClasses + 1;  // with "not in use"
constexpr unsigned kStepBits = 6, kStepMask = (1U << kStepBits) - 1;
static_assert(LabelEvidence::kMost == kStepMask);
static_assert(kNames * kNames * kNames <= 1U << (31 - 3 * kStepBits));

// exp(steps / 8). Products alone, which every machine rounds alike, where exp() differs from library to library.
constexpr std::array<double, LabelEvidence::kMost + 1> kLikelier = [] {
  constexpr double kEighth = 1.1331484530668263;  // exp(1/8)
  std::array<double, LabelEvidence::kMost + 1> table{1.0};
  for (std::size_t i = 1; i < table.size(); ++i) table[i] = table[i - 1] * kEighth;
  return table;
}();

// Between the grades' probabilities, halfway in logits. A test computes them.
constexpr std::array<double, VoxelLabel::kGrades - 1> kGradeFrom{0.8971, 0.7101, 0.4733};
// ln(18 p / (1 − p)) of the grades' probabilities, in steps.
constexpr std::array<unsigned, VoxelLabel::kGrades> kStepsOfGrade{47, 34, 26, 18};

/// How much likelier than an unlisted class all classes together are.
double total(const std::array<LabelEvidence::Entry, LabelEvidence::kListed>& entries) {
  double sum = kClasses;
  for (const auto& entry : entries)
    if (entry.class_id != kNoClass) sum += kLikelier[entry.steps] - 1;
  return sum;
}

}  // namespace

LabelEvidence LabelEvidence::from_id(std::uint32_t label_id) {
  LabelEvidence evidence;
  if ((label_id & kMark) == 0) {
    const VoxelLabel label = VoxelLabel::from_id(label_id);
    if (label.any()) evidence.add(static_cast<std::uint8_t>(label.class_id()), kStepsOfGrade[label.grade()]);
    return evidence;
  }
  std::uint32_t names = (label_id & ~kMark) >> (kListed * kStepBits);
  for (unsigned i = 0; i < kListed; ++i, names /= kNames) {
    const std::uint32_t name = names % kNames;
    if (name == kClasses) continue;
    evidence.entries_[i] = {static_cast<std::uint8_t>(name),
                            static_cast<std::uint8_t>(label_id >> (i * kStepBits) & kStepMask)};
  }
  return evidence.id() == label_id ? evidence : LabelEvidence();
}

std::uint32_t LabelEvidence::id() const {
  if (!any()) return 0;
  LabelEvidence ordered = *this;
  ordered.put_in_order();
  std::uint32_t names = 0, steps = 0;
  for (unsigned i = kListed; i-- > 0;) {
    const Entry& entry = ordered.entries_[i];
    names = names * kNames + (entry.class_id == kNoClass ? kClasses : entry.class_id);
    steps = steps << kStepBits | entry.steps;
  }
  return kMark | names << (kListed * kStepBits) | steps;
}

void LabelEvidence::add(std::uint8_t class_id, unsigned steps) {
  steps = std::min(steps, kMost);
  if (class_id >= kClasses || steps == 0) return;
  auto entry = std::ranges::find(entries_, class_id, &Entry::class_id);
  if (entry == entries_.end()) entry = std::ranges::find(entries_, kNoClass, &Entry::class_id);
  if (entry == entries_.end()) {
    Entry& last = entries_.back();
    last = last.steps >= steps ? Entry{last.class_id, static_cast<std::uint8_t>(last.steps - steps)}
                               : Entry{class_id, static_cast<std::uint8_t>(steps - last.steps)};
    return put_in_order();
  }
  const unsigned sum = (entry->class_id == class_id ? entry->steps : 0U) + steps;
  const unsigned excess = sum > kMost ? sum - kMost : 0;
  for (Entry& other : entries_)
    other.steps = static_cast<std::uint8_t>(other.steps - std::min<unsigned>(other.steps, excess));
  *entry = {class_id, static_cast<std::uint8_t>(sum - excess)};
  put_in_order();
}

void LabelEvidence::put_in_order() {
  for (Entry& entry : entries_)
    if (entry.steps == 0 || entry.class_id >= kClasses) entry = {};
  std::ranges::sort(entries_, [](const Entry& a, const Entry& b) {
    return a.steps != b.steps ? a.steps > b.steps : a.class_id < b.class_id;
  });
}

std::array<double, VoxelLabel::kClasses> LabelEvidence::probabilities() const {
  std::array<double, kClasses> p{};
  const double sum = total(entries_);
  p.fill(1 / sum);
  for (const Entry& entry : entries_)
    if (entry.class_id != kNoClass) p[entry.class_id] = kLikelier[entry.steps] / sum;
  return p;
}

VoxelLabel LabelEvidence::label() const {
  if (!any()) return {};
  const double p = kLikelier[entries_[0].steps] / total(entries_);
  unsigned grade = 0;
  while (grade < kGradeFrom.size() && p < kGradeFrom[grade]) ++grade;
  return VoxelLabel::of(entries_[0].class_id, grade);
}

VoxelLabel VoxelLabel::from_id(std::uint32_t label_id) {
  if ((label_id & LabelEvidence::kMark) != 0) return LabelEvidence::from_id(label_id).label();
  return {label_id <= kCodes ? static_cast<std::uint8_t>(label_id) : std::uint8_t{0}};
}

bool is_label_id(std::uint32_t label_id) {
  return (label_id & LabelEvidence::kMark) != 0 ? LabelEvidence::from_id(label_id).any()
                                                : label_id <= VoxelLabel::kCodes;
}

}  // namespace cairn::mapping
