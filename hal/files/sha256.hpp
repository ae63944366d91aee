// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "hal/result.hpp"

namespace cairn {

/// SHA-256 (FIPS 180-4) over bytes given piece by piece; OpenSSL does the work.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  /// Adds bytes to the sum.
  void update(std::span<const std::byte> bytes);
  /// 64 lower-case hexadecimal digits. Ends the sum: nothing may follow.
  [[nodiscard]] std::string finish();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// The sum over the bytes of all files one after the other, as `cat FILE… | sha256sum` prints it.
Result<std::string> sha256_of_files(std::span<const std::filesystem::path> files);

}  // namespace cairn
