// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "hal/ports.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/perception/calibration/board.hpp"
#include "tools/cli/calibrate/board_search.hpp"

namespace cairn::cli {

/// Says, while boards are recorded, which views are still missing for a calibration.
class ViewGuide {
 public:
  /// `inverted`: squares that are dark on the board are bright in the pictures.
  ViewGuide(const calibration::Board& board, bool inverted) : board_(board), inverted_(inverted) {}

  /// Looks for the board in the picture of one eye. True: it shows a view that differs from those before.
  bool look(const ImageView& picture);
  [[nodiscard]] std::size_t views() const { return views_.size(); }
  /// See calibration::Coverage. Empty: nothing.
  [[nodiscard]] const std::vector<std::string>& missing() const { return missing_; }
  /// One line for who holds the board.
  [[nodiscard]] std::string text() const;

 private:
  void find_missing(int width, int height);

  calibration::Board board_;
  bool inverted_;
  std::vector<calibration::Corners> views_;
  std::vector<std::string> missing_;
};

/// Hands on what another source gives, and shows a picture of one camera to a guide, twice a second at most. Meanwhile
/// the other packets wait in their queues, so looking takes at most a fifth of the time.
class GuidedSource final : public Source {
 public:
  static constexpr Duration kPace = std::chrono::milliseconds(500);
  static constexpr int kShare = 5;  ///< a look is followed by so many times its CPU time without one

  /// All must outlive it. `side_by_side`: the left half of each picture is looked at. `on_view` is called after each
  /// new view.
  GuidedSource(Source& source, SourceId camera, PictureDecoder decode, bool side_by_side, ViewGuide& guide,
               std::function<void()> on_view)
      : source_(source),
        camera_(camera),
        decode_(std::move(decode)),
        side_by_side_(side_by_side),
        guide_(guide),
        on_view_(std::move(on_view)) {}

  Result<Poll> next(Packet& packet, Duration timeout) override;

 private:
  void show(const Packet& packet);

  Source& source_;
  SourceId camera_;
  PictureDecoder decode_;
  bool side_by_side_;
  ViewGuide& guide_;
  std::function<void()> on_view_;
  Time due_{};
};

}  // namespace cairn::cli
