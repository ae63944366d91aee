// SPDX-License-Identifier: Apache-2.0
#include "hal/files/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <cstdlib>
#include <vector>

#include "hal/files/input_file.hpp"

namespace cairn {
namespace {

// OpenSSL refuses here only when memory is exhausted or its own installation is broken.
void must(bool ok) {
  if (!ok) std::abort();
}

}  // namespace

struct Sha256::Context {
  EVP_MD_CTX* evp = EVP_MD_CTX_new();
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() { EVP_MD_CTX_free(evp); }
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  must(context_->evp != nullptr && EVP_DigestInit_ex(context_->evp, EVP_sha256(), nullptr) == 1);
}

Sha256::~Sha256() = default;

void Sha256::update(std::span<const std::byte> bytes) {
  must(EVP_DigestUpdate(context_->evp, bytes.data(), bytes.size()) == 1);
}

std::string Sha256::finish() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  must(EVP_DigestFinal_ex(context_->evp, digest.data(), &size) == 1);
  constexpr const char* kDigits = "0123456789abcdef";
  std::string hex;
  for (unsigned i = 0; i < size; ++i) {
    hex += kDigits[digest[i] >> 4U];
    hex += kDigits[digest[i] & 15U];
  }
  return hex;
}

Result<std::string> sha256_of_files(std::span<const std::filesystem::path> files) {
  Sha256 sum;
  std::vector<std::byte> buffer(1 << 16);
  for (const auto& path : files) {
    auto file = InputFile::open(path);
    if (!file) return file.error();
    for (;;) {
      const auto read = file->read(buffer);
      if (!read) return read.error();
      if (*read == 0) break;
      sum.update(std::span(buffer).first(*read));
    }
  }
  return sum.finish();
}

}  // namespace cairn
