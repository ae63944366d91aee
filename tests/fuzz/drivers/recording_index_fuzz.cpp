// SPDX-License-Identifier: Apache-2.0
// Any text is either an index or a list of faults, as recording.yaml and as data.csv; what was read survives being
// written and read again, and never names a file outside of its folder.
#include <string>
#include <string_view>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "tests/fuzz/require.hpp"

using namespace cairn;
using namespace cairn::recording;

namespace {

void as_recording(std::string_view text) {
  const auto read = parse_recording(text, "fuzz");
  if (!read) return require(!read.error().detail.empty());
  for (const SourceEntry& s : read->sources) require(path_fault(s.file) == nullptr);
  const std::string written = to_yaml(*read);
  const auto again = parse_recording(written, "written");
  require(again.has_value());
  require(to_yaml(*again) == written);
}

void as_scan_index(std::string_view text) {
  std::vector<ScanIndexEntry> entries, again;
  static_cast<void>(parse_scan_index(text, "fuzz", entries));
  std::string written(kScanIndexHeader);
  for (const ScanIndexEntry& e : entries) {
    require(path_fault(e.file) == nullptr);
    written += to_csv(e);
  }
  require(parse_scan_index(written, "written", again).has_value());
  require(again.size() == entries.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  as_recording(text);
  as_scan_index(text);
  return 0;
}
