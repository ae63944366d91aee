// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "hal/result.hpp"

namespace cairn {

/// Whether `inner` is `outer` or lies somewhere in it, by whatever names: links and mounts are followed. Neither needs
/// to exist.
[[nodiscard]] bool lies_in(const std::filesystem::path& inner, const std::filesystem::path& outer);
/// Error kInvalidConfig: writing to `output` would destroy `input`, because one is the other or lies in it. Both may be
/// files or folders.
[[nodiscard]] Result<void> keep_input(const std::filesystem::path& input, const std::filesystem::path& output);

/// Error kIo: `folder` exists and is not an empty folder; `remedy` is its detail.
[[nodiscard]] Result<void> require_new_folder(const std::filesystem::path& folder, std::string remedy);

/// A folder that appears whole or not at all. It is written under another name and takes its place at the end. If its
/// program is killed, its name says what it is.
class UnfinishedFolder {
 public:
  /// Makes the folder TARGET.unfinished, and the folders above it. It gets a number where a killed program left one.
  /// Errors: kIo (the system refuses); kInvalidConfig (`target` cannot be replaced: it is the current folder, a mounted
  /// disk or no folder).
  [[nodiscard]] static Result<UnfinishedFolder> beside(const std::filesystem::path& target);
  /// Makes the folder OUT/unfinished, and `out`. What a killed program left there is removed. Error kIo: the system
  /// refuses, or another program is writing there.
  [[nodiscard]] static Result<UnfinishedFolder> inside(const std::filesystem::path& out);

  UnfinishedFolder(UnfinishedFolder&& other) noexcept;
  UnfinishedFolder& operator=(UnfinishedFolder&&) = delete;
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;
  /// Removes the folder, unless it took a place or was left.
  ~UnfinishedFolder();

  /// Where to write.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Becomes `target`, which does not exist or is an empty folder. Error kIo.
  [[nodiscard]] Result<void> become(const std::filesystem::path& target);
  /// Changes places with the folder `target` in one step, where the file system can; path() is the old folder then.
  /// Error kIo.
  [[nodiscard]] Result<void> swap_with(const std::filesystem::path& target);
  /// Moves its files into `target`, over those of the same name; `last` comes last. Each is whole at any time. Error
  /// kIo.
  [[nodiscard]] Result<void> move_files_into(const std::filesystem::path& target, const std::filesystem::path& last);
  /// Stays where it is, under its name.
  void leave();
  /// For what can be made again: the error of writing in this folder, with what becomes of it and the remedy. Other
  /// errors stay as they are.
  [[nodiscard]] Error nothing_kept(Error error) const;

 private:
  UnfinishedFolder(std::filesystem::path path, int lock) : path_(std::move(path)), lock_(lock) {}

  std::filesystem::path path_;  // empty: nothing to remove
  int lock_ = -1;
};

}  // namespace cairn
