// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "hal/image.hpp"
#include "tools/python/recorded_source.hpp"

namespace cairn::python {

/// One picture as Python sees it.
struct PyPicture {
  std::string sensor;
  std::int64_t stamp_ns = 0;
  py::array pixels;
};

/// Iterates over the pictures of one camera.
class RecordedPictures {
 public:
  /// Throws Failure: see RecordedSource; the model is unknown.
  RecordedPictures(const std::filesystem::path& folder, const recording::Recording& recording, std::size_t index);

  /// Throws StopIteration at the end.
  [[nodiscard]] PyPicture next();
  [[nodiscard]] const RecordedSource& source() const { return source_; }

 private:
  /// The picture of a packet; null: the device repeated its last one.
  using Decode = std::function<Result<const Image*>(const Packet&)>;

  [[nodiscard]] static Decode make_decoder(const recording::SourceEntry& entry);
  [[nodiscard]] const Image* find_next();

  std::string id_;
  RecordedSource source_;
  Decode decode_;
};

void add_recorded_pictures(py::module_& module);

}  // namespace cairn::python
