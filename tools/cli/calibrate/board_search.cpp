// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/board_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "drivers/camera/camera.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/thermal/thermal.hpp"
#include "onboard/app/profile/recorded_profile.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using calibration::Corners;

Error wrong(const fs::path& recording, std::string_view cause, std::string detail) {
  return {Errc::kInvalidConfig, cause, recording.string(), {}, std::move(detail)};
}

std::optional<SourceId> camera_of(const recording::Recording& recording, recording::SensorKind kind) {
  for (std::size_t i = 0; i < recording.sources.size(); ++i)
    if (recording.sources[i].kind == kind) return static_cast<SourceId>(i);
  return {};
}

/// Looks at the pictures of one recording.
class Search {
 public:
  Search(const BoardSearch& search, std::size_t index, BoardsFound& found)
      : search_(search), index_(index), found_(found) {}

  Result<void> run() {
    const fs::path& path = search_.recordings[index_];
    const auto chosen = app::choose_profile(search_.config, path);
    if (!chosen) return chosen.error();
    side_by_side_ = !search_.thermal && chosen->profile.camera.driver.side_by_side;
    if (search_.eyes == BoardSearch::Eyes::kBoth && !side_by_side_)
      return wrong(path, "the profile's camera has one eye",
                   "set camera.side_by_side, or name a profile with --config");
    auto reader = recording::RecordingReader::open(path);
    if (!reader) return reader.error();
    const auto decode = decoder_of_pictures(chosen->profile, search_.thermal);
    if (!decode) return decode.error();
    const auto source = camera_of((*reader)->recording(), search_.thermal ? recording::kThermal : recording::kCamera);
    if (!source)
      return Error{Errc::kNotFound,
                   "the recording lacks a sensor",
                   path.string(),
                   {},
                   search_.thermal ? "a thermal camera" : "a camera"};
    return read(**reader, *decode, *source);
  }

 private:
  Result<void> read(recording::RecordingReader& reader, const PictureDecoder& decode, SourceId source) {
    int skipped = search_.every - 1;
    for (Packet packet;;) {
      const auto poll = reader.next(packet, {});
      if (!poll) ++found_.unreadable;
      if (!poll || *poll == Poll::kTimeout) continue;
      if (*poll == Poll::kEnd) return {};
      if (packet.source != source || ++skipped < search_.every) continue;
      skipped = 0;
      const auto picture = decode(packet);
      if (!picture) {
        ++found_.unreadable;
        continue;
      }
      if (*picture == nullptr) continue;
      if (auto looked = look(**picture); !looked) return looked;
    }
  }

  Result<void> look(const Image& picture) {
    std::vector<ImageView> eyes{picture.view()};
    if (side_by_side_) {
      const auto both = camera::split_side_by_side(picture.view());
      if (!both) return at(search_.recordings[index_].string(), both.error());
      eyes = {both->left, both->right};
    }
    if (search_.eyes == BoardSearch::Eyes::kLeft) eyes.resize(1);
    if (auto same = check_size(eyes[0]); !same) return same;
    ++found_.pictures;
    SeenBoard seen{.recording = index_, .stamp = picture.stamp, .eyes = {}};
    for (const ImageView& eye : eyes) {
      auto corners = calibration::find_corners(eye, search_.board, search_.inverted);
      if (!corners) return {};
      if (!seen.eyes.empty()) corners = calibration::ordered_like(seen.eyes[0], *std::move(corners));
      seen.eyes.push_back(*std::move(corners));
    }
    found_.boards.push_back(std::move(seen));
    return {};
  }

  Result<void> check_size(const ImageView& eye) {
    if (found_.pictures == 0) {
      found_.width = eye.width;
      found_.height = eye.height;
    }
    if (eye.width == found_.width && eye.height == found_.height) return {};
    return wrong(search_.recordings[index_], "pictures of different sizes do not give one calibration",
                 fmt::format("{}x{}, the first has {}x{}", eye.width, eye.height, found_.width, found_.height));
  }

  const BoardSearch& search_;
  std::size_t index_;
  BoardsFound& found_;
  bool side_by_side_ = false;
};

Error not_found(const BoardSearch& search, const BoardsFound& found) {
  return {Errc::kNotFound,
          "the board was not found in any picture",
          search.recordings[0].string(),
          {},
          fmt::format(
              "looked for {}x{} inner corners in {} pictures of {}x{} pixels ({} unreadable): check --board; the "
              "whole board with a white rim has to be in the picture, sharp and evenly lit",
              search.board.columns, search.board.rows, found.pictures, found.width, found.height, found.unreadable)};
}

}  // namespace

Result<PictureDecoder> decoder_of_pictures(const app::RobotProfile& profile, bool thermal) {
  if (!thermal) {
    auto camera = camera::Camera::create(profile.camera.driver);
    if (!camera) return camera.error();
    return PictureDecoder(
        [eye = std::make_shared<camera::Camera>(*std::move(camera))](const Packet& p) { return eye->decode(p); });
  }
  auto camera = thermal::Thermal::create(profile.thermal.driver);
  if (!camera) return camera.error();
  return PictureDecoder(
      [eye = std::make_shared<thermal::Thermal>(*std::move(camera))](const Packet& p) -> Result<const Image*> {
        const auto seen = eye->decode(p);
        if (!seen) return seen.error();
        return *seen == nullptr || (*seen)->correcting ? nullptr : &(*seen)->stretched;
      });
}

std::vector<Corners> BoardsFound::corners(std::size_t eye) const {
  std::vector<Corners> all;
  all.reserve(boards.size());
  for (const SeenBoard& seen : boards) all.push_back(seen.eyes[eye]);
  return all;
}

Result<BoardsFound> search_boards(const BoardSearch& search) {
  BoardsFound found;
  for (std::size_t i = 0; i < search.recordings.size(); ++i)
    if (auto done = Search(search, i, found).run(); !done) return done.error();
  if (found.boards.empty()) return not_found(search, found);
  return found;
}

}  // namespace cairn::cli
