// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/files/append_file.hpp"
#include "hal/ports.hpp"
#include "hal/result.hpp"

// boxes.csv: what detectors found in the pictures of a recording. A line is
// stamp_ns,camera,x,y,width,height,class,score with pixels of the picture and a trainId. A line with stamp and camera
// alone says that nothing was found. Lines are in the order of their stamps; those of one picture follow each other.
// Lines that begin with # are comments.
namespace cairn::networks {

inline constexpr const char* kBoxFile = "boxes.csv";  ///< beside recording.yaml
inline constexpr std::string_view kBoxHeader = "#stamp_ns,camera,x,y,width,height,class,score\n";
inline constexpr std::size_t kMaxBoxFileBytes = std::size_t{64} << 20U;
inline constexpr std::size_t kMaxBoxPictures = 1'000'000;  ///< of one file: two days at 5 Hz
inline constexpr std::size_t kMaxBoxesOfPicture = 1000;

/// What was found in one picture.
struct RecordedBoxes {
  Time stamp{};
  std::string camera;  ///< id of the recording's source: letters, digits, `_`, `-`, `.`
  std::vector<Detection> found;
};

/// Reads boxes.csv. What comes before a fault is kept in `pictures`; the Error names line and byte offset.
[[nodiscard]] Result<void> parse_boxes(std::string_view text, std::string_view name,
                                       std::vector<RecordedBoxes>& pictures);
/// The lines of one picture.
[[nodiscard]] std::string to_csv(const RecordedBoxes& picture);

/// Answers with what is in such a file.
class RecordedDetector final : public Detector {
 public:
  /// Reads the file whole. `camera`: whose lines count. Errors: those of read_file(). A fault in the file is in
  /// damage(), and what comes before it counts.
  [[nodiscard]] static Result<std::unique_ptr<RecordedDetector>> open(const std::filesystem::path& file,
                                                                      const std::string& camera);

  /// The boxes of the picture's stamp, clipped to the picture. Error kNotFound: the file has no line of it.
  Result<const Detections*> detect(const Image& picture) override;
  [[nodiscard]] const std::optional<Error>& damage() const { return damage_; }
  [[nodiscard]] std::size_t pictures() const { return pictures_.size(); }

 private:
  RecordedDetector() = default;

  std::string name_;
  std::vector<RecordedBoxes> pictures_;  // of this camera, in the order of their stamps
  std::optional<Error> damage_;
  Detections detections_;
};

/// Writes such a file, whole pictures at a time.
class BoxWriter {
 public:
  /// Creates or empties `file`. Error kIo.
  [[nodiscard]] static Result<BoxWriter> create(const std::filesystem::path& file);

  /// Errors: kMalformed (the stamp is below the last one, the camera's name is none, a box is none); kIo. Nothing of
  /// the picture is written then.
  [[nodiscard]] Result<void> write(const std::string& camera, const Detections& detections);
  /// Hands everything to the operating system; call it about once a second.
  [[nodiscard]] Result<void> flush() { return file_.flush(); }
  [[nodiscard]] Result<void> close() { return file_.close(); }

 private:
  explicit BoxWriter(AppendFile file) : file_(std::move(file)) {}

  AppendFile file_;
  std::optional<Time> last_;
};

}  // namespace cairn::networks
