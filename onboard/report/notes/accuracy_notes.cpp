// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "onboard/report/figures/accuracy.hpp"
#include "onboard/report/notes/note_list.hpp"

namespace cairn::report {
namespace {

void note_error(NoteList& notes, const TrajectoryError& e) {
  if (e.unmatched > 0)
    notes.warning(fmt::format("{} poses have no ground truth and are left out of the errors.", e.unmatched), {});
  if (!e.final_error_percent) return;
  const double percent = 100 * e.ate_rmse_m / e.length_m;
  if (std::max(percent, *e.final_error_percent) <= kLargeError_percent) return;
  notes.error(fmt::format("The trajectory is off: {} m RMS and {} m at the end of {} m.", plain(e.ate_rmse_m),
                          plain(e.final_error_m), plain(e.length_m)),
              "check that the ground truth is of this drive, and the mount and model of the LiDAR in the profile");
}

/// Where the stated covariance is honest, 3 σ hold 99.7 % of the errors.
void note_covariance(NoteList& notes, std::span<const PoseError> errors) {
  constexpr double kHonest = 0.95, kUseless = 0.5;
  std::string held, axes;
  double least = 1;
  const auto inside = share_inside_3_sigma(errors);
  for (std::size_t i = 0; const char* axis : {"x", "y", "z", "roll", "pitch", "yaw"}) {
    const auto share = inside[i++];
    if (!share || *share >= kHonest) continue;
    held += fmt::format("{}{:.0f} %", held.empty() ? "" : ", ", 100 * *share);
    axes += fmt::format("{}{}", axes.empty() ? "" : ", ", axis);
    least = std::min(least, *share);
  }
  if (axes.empty()) return;
  std::string text =
      fmt::format("The stated covariance is too small: 3 sigma hold {} of the errors in {}.", held, axes);
  const char* remedy = "do not weigh these poses by their covariance";
  least < kUseless ? notes.error(std::move(text), remedy) : notes.warning(std::move(text), remedy);
}

}  // namespace

void note_accuracy(NoteList& notes, const RunReport& report) {
  const Accuracy accuracy = accuracy_of(report);
  if (!accuracy.why_not.empty())
    notes.warning("The ground truth was not compared: " + accuracy.why_not + ".",
                  "check that it is of this drive and on the same time line");
  if (accuracy.error) note_error(notes, *accuracy.error);
  note_covariance(notes, accuracy.pose_errors);
}

}  // namespace cairn::report
