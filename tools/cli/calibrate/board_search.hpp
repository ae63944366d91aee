// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hal/image.hpp"
#include "hal/packet.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/perception/calibration/board.hpp"

namespace cairn::cli {

/// Where to look for the board.
struct BoardSearch {
  /// Whose pictures.
  enum class Eyes : std::uint8_t { kLeft, kBoth };
  std::vector<std::filesystem::path> recordings;
  std::filesystem::path config;  ///< robot profile; empty: each recording's own
  calibration::Board board;
  Eyes eyes = Eyes::kLeft;
  int every = 1;          ///< look at every so many pictures
  bool thermal = false;   ///< the thermal camera's pictures, stretched to 8 bits; it has one eye
  bool inverted = false;  ///< squares that are dark on the board are bright in the pictures
};

/// From a camera's packet to its picture; null: there is nothing to look at in it.
using PictureDecoder = std::function<Result<const Image*>(const Packet&)>;
/// That of the colour camera, or of the thermal one, whose pictures are stretched to 8 bits. Errors: those of the
/// driver's settings.
[[nodiscard]] Result<PictureDecoder> decoder_of_pictures(const app::RobotProfile& profile, bool thermal);

/// The board in one picture.
struct SeenBoard {
  std::size_t recording = 0;  ///< index
  Time stamp{};               ///< of the picture
  std::vector<calibration::Corners> eyes;
};

/// The result of a search.
struct BoardsFound {
  int width = 0, height = 0;  ///< of the pictures of one eye
  std::vector<SeenBoard> boards;
  std::size_t pictures = 0, unreadable = 0;  ///< looked at; packets that could not be decoded

  /// The corners that eye `eye` saw, one element a board.
  [[nodiscard]] std::vector<calibration::Corners> corners(std::size_t eye) const;
};

/// Looks for the board in the pictures of the camera, or of the thermal one. Pictures during a flat-field
/// correction are left out. With both eyes, both have to see it. Errors: those of recordings and
/// profiles; kNotFound: a recording lacks a camera, or no picture shows the board; kInvalidConfig: pictures of
/// different sizes, or of one eye where two are needed.
[[nodiscard]] Result<BoardsFound> search_boards(const BoardSearch& search);

}  // namespace cairn::cli
