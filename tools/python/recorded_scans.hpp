// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hal/monitor.hpp"
#include "hal/ports.hpp"
#include "tools/python/recorded_source.hpp"

namespace cairn::python {

/// One revolution of a LiDAR as Python sees it.
struct PyScan {
  std::string sensor;
  std::int64_t start_ns = 0, end_ns = 0;
  py::array_t<float> xyz, intensity;
  py::array_t<std::uint32_t> offset_ns;
  py::array_t<std::uint8_t> ring;
  bool incomplete = false;
};

/// Iterates over the scans of one source. Everything that was measured, without the gates of a robot's profile.
class RecordedScans {
 public:
  /// Throws Failure: see RecordedSource; the model is unknown.
  RecordedScans(const std::filesystem::path& folder, const recording::Recording& recording, std::size_t index);

  /// Throws StopIteration at the end.
  [[nodiscard]] PyScan next();
  [[nodiscard]] const RecordedSource& source() const { return source_; }

 private:
  [[nodiscard]] const Scan* find_next();

  std::string id_;
  RecordedSource source_;
  std::unique_ptr<Monitor> monitor_ = std::make_unique<Monitor>();  // at one place, wherever this moves
  std::unique_ptr<ScanDecoder> decoder_;
  bool flushed_ = false;
};

void add_recorded_scans(py::module_& module);

}  // namespace cairn::python
