// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/new_recording.hpp"

#include <array>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/source_writer.hpp"
#include "hal/files/file.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;

/// What a recording may hold besides the files of its sources.
constexpr std::array kOwnNames{kIndexFile,  "ground_truth.tum", kProfileFile, "schedule.log",   "resume",  "labels",
                               "boxes.csv", "lidar_labels.bin", "people.csv", "true_boxes.csv", "world.ot"};

Error in_the_way(const fs::path& file) {
  return {Errc::kIo,
          "there is a recording already",
          file.string(),
          {},
          "choose another folder, or replace it with --overwrite"};
}

/// A recording among others would make a recording of their folder.
Result<void> refuse_folder_of_recordings(const fs::path& place) {
  std::error_code error;
  if (fs::exists(place / kIndexFile, error)) return {};
  for (const auto& entry : fs::directory_iterator(place, error))
    if (fs::exists(entry.path() / kIndexFile, error))
      return Error{Errc::kIo,
                   "the folder holds recordings",
                   place.string(),
                   {},
                   "name a new folder in it, such as " + (place / "new").string()};
  return {};
}

/// The sources that the index names, though their files may be missing.
std::vector<SourceEntry> sources_of(const fs::path& old) {
  constexpr std::uint64_t kMaxIndexBytes = 256 * 1024;
  const auto bytes = read_file(old / kIndexFile, kMaxIndexBytes);
  if (!bytes) return {};
  auto recording = parse_recording({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, kIndexFile);
  return recording ? std::move(recording->sources) : std::vector<SourceEntry>();
}

/// Removes the files of a source that lie in `old`, whatever links say.
void remove_files(const fs::path& old, const SourceEntry& source) {
  std::error_code ignored;
  for (const fs::path& file : existing_files(old, source))
    if (lies_in(file.parent_path(), old)) fs::remove(file, ignored);
}

/// Removes `folder` and the folders in it, where they hold nothing.
void prune(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> folders{folder};
  for (const auto& entry :
       fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error))
    if (!entry.is_symlink(error) && entry.is_directory(error)) folders.push_back(entry.path());
  for (; !folders.empty(); folders.pop_back()) fs::remove(folders.back(), error);  // fails if it holds anything
}

}  // namespace

Result<NewRecording> NewRecording::begin(const fs::path& place, Overwrite overwrite) {
  std::error_code ignored;
  if (overwrite == Overwrite::kNo && fs::exists(fs::symlink_status(place / kIndexFile, ignored)))
    return in_the_way(place / kIndexFile);
  if (const auto fit = refuse_folder_of_recordings(place); !fit) return fit.error();
  auto folder = UnfinishedFolder::beside(place);
  if (!folder) return folder.error();
  return NewRecording(std::move(*folder), place, overwrite);
}

Result<void> NewRecording::finish() {
  Result<void> done = put_in_place();
  if (done) return done;
  Error error = done.error();
  error.detail += (error.detail.empty() ? "" : "; ") + ("the recording is in " + folder().string());
  leave();
  return error;
}

Result<void> NewRecording::put_in_place() {
  std::error_code error;
  if (!fs::exists(place_, error) || fs::is_empty(place_, error)) return folder_.become(place_);
  if (auto free = check_names(); !free) return free;
  if (auto swapped = folder_.swap_with(place_); !swapped) return swapped;
  keep_what_is_not_the_recordings();
  return {};
}

Result<void> NewRecording::check_names() const {
  if (overwrite_ == Overwrite::kYes) return {};
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder(), error))
    if (const fs::path old = place_ / entry.path().filename(); fs::exists(fs::symlink_status(old, error)))
      return in_the_way(old);
  return {};
}

/// After the swap, folder() is what was there before.
void NewRecording::keep_what_is_not_the_recordings() {
  const fs::path& old = folder();
  std::error_code error;
  for (const SourceEntry& source : sources_of(old)) remove_files(old, source);
  for (const char* name : kOwnNames) fs::remove_all(old / name, error);
  prune(old);
  std::vector<fs::path> rest;
  for (const auto& entry : fs::directory_iterator(old, error)) rest.push_back(entry.path().filename());
  for (const fs::path& name : rest)
    if (!fs::exists(fs::symlink_status(place_ / name, error))) fs::rename(old / name, place_ / name, error);
}

}  // namespace cairn::recording
