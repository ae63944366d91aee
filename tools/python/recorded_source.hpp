// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "drivers/recording/recording_reader.hpp"
#include "tools/python/arrays.hpp"

namespace cairn::python {

/// The packets of one source of a recording, and what was wrong with them.
class RecordedSource {
 public:
  /// Throws Failure: its file cannot be opened.
  RecordedSource(const std::filesystem::path& folder, const recording::Recording& recording, std::size_t index)
      : source_(value_of(recording::open_recorded_source(folder, recording, index))) {}

  /// The next packet, or null at the end. It is valid until the next call.
  [[nodiscard]] const Packet* next() {
    for (;;) {
      const auto poll = source_->next(packet_, {});
      if (!poll) {
        note(poll.error());
      } else if (*poll == Poll::kEnd) {
        return nullptr;
      } else if (*poll == Poll::kPacket) {
        return &packet_;
      }
    }
  }
  /// Counts what was damaged; keeps the first messages.
  void note(const Error& error) {
    if (damaged_++ < kMostMessages) messages_.push_back(to_string(error));
  }

  [[nodiscard]] std::uint64_t damaged() const { return damaged_; }
  [[nodiscard]] const std::vector<std::string>& messages() const { return messages_; }

 private:
  static constexpr std::uint64_t kMostMessages = 16;

  std::unique_ptr<Source> source_;
  Packet packet_;
  std::uint64_t damaged_ = 0;
  std::vector<std::string> messages_;
};

inline constexpr const char* kAboutDamaged = "packets so far that could not be read; the others are not affected";
inline constexpr const char* kAboutMessages = "what was wrong with the first of them, as a list of texts";

}  // namespace cairn::python
