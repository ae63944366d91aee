// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <utility>

#include "hal/files/unfinished_folder.hpp"
#include "hal/result.hpp"

namespace cairn::recording {

/// What happens to an existing recording.
enum class Overwrite : bool { kNo, kYes };

/// A recording that appears in its place when it is whole. Until then it grows in a folder PLACE.unfinished.
class NewRecording {
 public:
  /// Nothing at `place` changes yet. Errors: those of UnfinishedFolder::beside(); kIo: there is a recording already
  /// and `overwrite` is kNo, or the folder holds recordings without being one.
  [[nodiscard]] static Result<NewRecording> begin(const std::filesystem::path& place, Overwrite overwrite);

  /// Where to write it.
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  /// Puts it into its place. The files and folders of an old recording go, and what else lies there stays. Error kIo:
  /// the system refuses, or there is a file of the same name and `overwrite` is kNo. Then the folder stays under its
  /// name.
  [[nodiscard]] Result<void> finish();
  /// The error of writing the recording, with what becomes of it where it can be made again.
  [[nodiscard]] Error nothing_kept(Error error) const { return folder_.nothing_kept(std::move(error)); }
  /// The folder stays under its name: for what cannot be made again. Without this and finish() it is removed.
  void leave() { folder_.leave(); }

 private:
  NewRecording(UnfinishedFolder folder, std::filesystem::path place, Overwrite overwrite)
      : folder_(std::move(folder)), place_(std::move(place)), overwrite_(overwrite) {}
  [[nodiscard]] Result<void> put_in_place();
  [[nodiscard]] Result<void> check_names() const;
  void keep_what_is_not_the_recordings();

  UnfinishedFolder folder_;
  std::filesystem::path place_;
  Overwrite overwrite_;
};

}  // namespace cairn::recording
