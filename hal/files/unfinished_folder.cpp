// SPDX-License-Identifier: Apache-2.0
#include "hal/files/unfinished_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace cairn {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLeftovers = 1000;  // that are kept

Error refused(std::string_view cause, const fs::path& path, const std::error_code& error) {
  return {Errc::kIo, cause, path.string(), {}, error.message()};
}
std::error_code last_error() { return {errno, std::generic_category()}; }

/// Without links and without a `/` at its end.
fs::path real_path(const fs::path& path) {
  std::error_code error;
  fs::path real = fs::weakly_canonical(fs::absolute(path, error), error);
  return real.has_filename() ? real : real.parent_path();
}

/// The folder's descriptor, locked; −1: another program holds the lock. A file system without locks locks nothing.
int lock_folder(const fs::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0 || ::flock(fd, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return fd;
  ::close(fd);
  return -1;
}

/// Found out before the work: at its end the system would refuse.
Result<void> check_replaceable(const fs::path& real) {
  const auto no = [&](std::string_view cause, const char* remedy) {
    return Error{Errc::kInvalidConfig, cause, real.string(), {}, remedy};
  };
  std::error_code error;
  if (lies_in(fs::current_path(error), real))
    return no("the current folder cannot be replaced", "go to another folder, or name a new one");
  struct stat own {
  }, above{};
  if (::stat(real.c_str(), &own) != 0) return {};
  if (!S_ISDIR(own.st_mode)) return no("the output is a folder, but this is a file", "name another");
  if (::stat(real.parent_path().c_str(), &above) == 0 && own.st_dev != above.st_dev)
    return no("a mounted disk cannot be replaced", "name a new folder on it");
  return {};
}

Result<void> make_parents(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) return refused("cannot make the folder", path.parent_path(), error);
  return {};
}

Result<void> rename_over(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) return refused("cannot put the result into its place", to, error);
  return {};
}

}  // namespace

bool lies_in(const fs::path& inner, const fs::path& outer) {
  const fs::path wanted = real_path(outer);
  std::error_code error;
  for (fs::path at = real_path(inner);; at = at.parent_path()) {
    if (at == wanted || fs::equivalent(at, wanted, error)) return true;
    if (at == at.parent_path()) return false;
  }
}

Result<void> keep_input(const fs::path& input, const fs::path& output) {
  if (!lies_in(input, output) && !lies_in(output, input)) return {};
  return Error{Errc::kInvalidConfig,
               "the output would replace its own input",
               output.string(),
               {},
               "name another, outside " + input.string()};
}

Result<void> require_new_folder(const fs::path& folder, std::string remedy) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(folder, error))) return {};
  if (fs::is_directory(folder, error) && fs::is_empty(folder, error)) return {};
  return Error{Errc::kIo, "already exists and is not an empty folder", folder.string(), {}, std::move(remedy)};
}

Result<UnfinishedFolder> UnfinishedFolder::beside(const fs::path& target) {
  const fs::path real = real_path(target);
  if (auto sound = check_replaceable(real); !sound) return sound.error();
  if (auto made = make_parents(real); !made) return made.error();
  const std::string name = real.string() + ".unfinished";
  for (int number = 1; number <= kMostLeftovers; ++number) {
    const fs::path path = number == 1 ? name : name + "-" + std::to_string(number);
    std::error_code error;
    if (fs::create_directory(path, error)) return UnfinishedFolder(path, -1);
    if (error) return refused("cannot make the folder", path, error);
  }
  return Error{Errc::kLimit, "too many unfinished folders", name, {}, "remove those that nobody needs"};
}

Result<UnfinishedFolder> UnfinishedFolder::inside(const fs::path& out) {
  const fs::path path = real_path(out) / "unfinished";
  if (auto made = make_parents(path); !made) return made.error();
  std::error_code error;
  if (!fs::create_directory(path, error) && error) return refused("cannot make the folder", path, error);
  const int lock = lock_folder(path);
  if (lock < 0)
    return Error{
        Errc::kIo, "another program is writing there", out.string(), {}, "wait for it, or name another folder"};
  for (const auto& leftover : fs::directory_iterator(path, error)) fs::remove_all(leftover.path(), error);
  return UnfinishedFolder(path, lock);
}

UnfinishedFolder::UnfinishedFolder(UnfinishedFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})), lock_(std::exchange(other.lock_, -1)) {}

UnfinishedFolder::~UnfinishedFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

void UnfinishedFolder::leave() { path_.clear(); }

Error UnfinishedFolder::nothing_kept(Error error) const {
  if (error.code != Errc::kIo || error.where.empty() || !lies_in(error.where, path_)) return error;
  error.detail += (error.detail.empty() ? "" : "; ") +
                  std::string("nothing was kept: free space on the disk, or name another --out, and run it again");
  return error;
}

Result<void> UnfinishedFolder::become(const fs::path& target) {
  if (auto renamed = rename_over(path_, real_path(target)); !renamed) return renamed;
  path_.clear();
  return {};
}

Result<void> UnfinishedFolder::swap_with(const fs::path& target) {
  const fs::path real = real_path(target);
  if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, real.c_str(), RENAME_EXCHANGE) == 0) return {};
  if (errno != EINVAL && errno != ENOSYS) return refused("cannot put the result into its place", real, last_error());
  const fs::path old = real.string() + ".replaced";  // between the two steps it is there under this name
  if (auto moved = rename_over(real, old); !moved) return moved;
  if (auto moved = rename_over(path_, real); !moved) return moved;
  return rename_over(old, path_);
}

Result<void> UnfinishedFolder::move_files_into(const fs::path& target, const fs::path& last) {
  std::error_code error;
  std::vector<fs::path> names;
  for (const auto& entry : fs::directory_iterator(path_, error))
    if (entry.path().filename() != last) names.push_back(entry.path().filename());
  if (fs::exists(path_ / last, error)) names.push_back(last);
  for (const fs::path& name : names)
    if (auto moved = rename_over(path_ / name, target / name); !moved) return moved;
  return {};
}

}  // namespace cairn
