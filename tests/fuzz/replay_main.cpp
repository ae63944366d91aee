// SPDX-License-Identifier: Apache-2.0
// Runs a fuzz target without a fuzzer: over every file of a corpus folder and over damaged copies of each, with a fixed
// seed. So the same properties are checked by every compiler, by both sanitisers and under qemu-user.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size);

namespace {

using Bytes = std::vector<unsigned char>;

Bytes read(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

Bytes damaged(Bytes bytes, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % std::max<std::size_t>(1, n); };
  if (random() % 3 == 0) bytes.resize(below(bytes.size() + 1));
  for (std::size_t flips = below(8); flips > 0 && !bytes.empty(); --flips)
    bytes[below(bytes.size())] = static_cast<unsigned char>(random() % 2 == 0 ? random() : 0xFFU);
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: %s CORPUS_FOLDER\n", argv[0]), 2;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::mt19937 random(1);
  constexpr int kCopies = 50;
  for (const auto& file : files) {
    const Bytes bytes = read(file);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    for (int i = 0; i < kCopies; ++i) {
      const Bytes copy = damaged(bytes, random);
      LLVMFuzzerTestOneInput(copy.data(), copy.size());
    }
  }
  std::printf("%zu files and %zu damaged copies\n", files.size(), files.size() * kCopies);
  return files.empty() ? 1 : 0;
}
