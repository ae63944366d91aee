// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/answer_log.hpp"

#include <algorithm>
#include <cstdio>

namespace cairn::app {

void AnswerLog::add(std::span<const people::Answered> answers) {
  const auto kept = answers.first(std::min(answers.size(), kMostRows - rows_.size()));
  rows_.insert(rows_.end(), kept.begin(), kept.end());
}

std::string AnswerLog::to_csv(Duration shift) const {
  std::string text = "t,camera,x,y,z,verdict,score,distance_m\n";
  char line[160];
  for (const people::Answered& r : rows_) {
    const int length =
        std::snprintf(line, sizeof line, "%.6f,%s,%.3f,%.3f,%.2f,%s,%.4f,%.2f\n", to_seconds(r.scan - shift - Time{}),
                      r.eye == people::Eye::kThermal ? "thermal" : "visible", static_cast<double>(r.body.x()),
                      static_cast<double>(r.body.y()), static_cast<double>(r.ground),
                      r.answer.verdict == people::Verdict::kPerson ? "person" : "silence",
                      static_cast<double>(r.answer.score), r.answer.distance);
    text.append(line, static_cast<std::size_t>(length));
  }
  return text;
}

}  // namespace cairn::app
