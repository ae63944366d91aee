// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/model/model_file.hpp"

#include <algorithm>
#include <cctype>
#include <system_error>
#include <utility>

#include "hal/files/file.hpp"
#include "hal/files/sha256.hpp"

namespace cairn::networks {
namespace {

namespace fs = std::filesystem;

bool same_sum(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

Error other_sum(const fs::path& path, const std::string& expected, const std::string& found) {
  return {Errc::kInvalidConfig,
          "the model is another one than the profile names",
          path.string(),
          {},
          "expected SHA-256 " + expected + ", found " + found +
              "; copy the right file, or put the found sum into the profile if you trust this file"};
}

}  // namespace

std::vector<fs::path> model_folders(const fs::path& profile) {
  std::vector<fs::path> folders{profile.has_parent_path() ? profile.parent_path() : fs::path(".")};
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(program.parent_path().parent_path() / "share/cairn/config");
  return folders;
}

Result<fs::path> find_model(const std::string& model, std::span<const fs::path> folders) {
  const fs::path here[] = {fs::path()};
  if (folders.empty() || fs::path(model).is_absolute()) folders = here;
  std::string places;
  for (const fs::path& folder : folders) {
    fs::path path = folder / model;
    std::error_code error;
    if (fs::exists(path, error)) return path;
    places += (places.empty() ? "" : ", ") + path.string();
  }
  return Error{Errc::kNotFound,
               "there is no such model",
               model,
               {},
               "looked for " + places + "; copy it there, or name another file as `model` in the profile"};
}

Result<ModelFile> read_model(const std::string& model, const std::string& sha256, std::span<const fs::path> folders) {
  auto path = find_model(model, folders);
  if (!path) return path.error();
  auto bytes = read_file(*path, kMaxModelBytes);
  if (!bytes) return bytes.error();
  Sha256 sum;
  sum.update(*bytes);
  std::string found = sum.finish();
  // A file that is cut off has another sum, too; where it ends says more.
  auto header = parse_onnx_header(*bytes);
  if (!header && header.error().code == Errc::kTruncated) return at(path->string(), header.error());
  if (!sha256.empty() && !same_sum(sha256, found)) return other_sum(*path, sha256, found);
  if (!header) return at(path->string(), header.error());
  return ModelFile{std::move(*path), std::move(*bytes), std::move(found), std::move(*header)};
}

}  // namespace cairn::networks
