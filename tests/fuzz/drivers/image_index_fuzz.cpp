// SPDX-License-Identifier: Apache-2.0
// Any text as a camera's data.csv: what was read never names a file outside of its folder, and survives being written
// and read again.
#include <cstdlib>
#include <string>

#include "drivers/recording/formats/image_folder.hpp"
#include "drivers/recording/formats/recording.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn::recording;
  std::vector<ImageIndexEntry> entries, again;
  static_cast<void>(parse_image_index({reinterpret_cast<const char*>(data), size}, "fuzz", entries));
  std::string written(kImageIndexHeader);
  for (const ImageIndexEntry& e : entries) {
    if (path_fault(e.file) != nullptr) std::abort();
    written += to_csv(e);
  }
  if (!parse_image_index(written, "written", again) || again.size() != entries.size()) std::abort();
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (again[i].stamp != entries[i].stamp || again[i].file != entries[i].file) std::abort();
  return 0;
}
