// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "onboard/perception/networks/model/onnx_header.hpp"

namespace cairn::networks {

/// Where models of a profile are looked for: the folder of the profile, then share/cairn/config of the installation
/// that the running program belongs to. `profile`: its file; empty: the current folder stands for its folder.
[[nodiscard]] std::vector<std::filesystem::path> model_folders(const std::filesystem::path& profile);

/// The file of a model: an absolute path as it is, a relative one in the first of the folders that has it. No folders:
/// in the current folder. Error kNotFound names all places.
[[nodiscard]] Result<std::filesystem::path> find_model(const std::string& model,
                                                       std::span<const std::filesystem::path> folders);

inline constexpr std::uint64_t kMaxModelBytes = std::uint64_t{256} << 20U;

/// A model's bytes, checked as far as that goes without running it.
struct ModelFile {
  std::filesystem::path path;
  std::vector<std::byte> bytes;
  std::string sha256;
  OnnxHeader header;
};

/// Reads a model. `sha256`: what the sum must be, in any case of letters; empty: not checked. Errors: those of
/// find_model(), read_file() and parse_onnx_header(), and kInvalidConfig for another sum.
[[nodiscard]] Result<ModelFile> read_model(const std::string& model, const std::string& sha256,
                                           std::span<const std::filesystem::path> folders);

}  // namespace cairn::networks
