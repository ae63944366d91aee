// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "hal/time.hpp"
#include "tools/ros/dds/ros_participant.hpp"

namespace cairn::ros {

/// What is written of one topic.
template <class Message>
class Writer {
 public:
  static Result<Writer> open(RosParticipant& participant, const std::string& topic, TopicUse use) {
    const auto writer = participant.writer(topic, ros_type<Message>(), use);
    if (!writer) return writer.error();
    return Writer(*writer);
  }
  /// False: it is lost, because a reader does not keep up.
  bool write(const Message& message) {
    const bool written = dds_write(writer_, &message) == DDS_RETCODE_OK;
    ++(written ? written_ : lost_);
    return written;
  }
  /// Whether somebody reads the topic now.
  [[nodiscard]] bool read_by_anybody() const {
    dds_publication_matched_status_t status{};
    return dds_get_publication_matched_status(writer_, &status) == DDS_RETCODE_OK && status.current_count > 0;
  }
  [[nodiscard]] std::uint64_t written() const { return written_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  explicit Writer(dds_entity_t writer) : writer_(writer) {}
  dds_entity_t writer_;
  std::uint64_t written_ = 0, lost_ = 0;
};

/// What is read of one topic.
template <class Message>
class Reader {
 public:
  static Result<Reader> open(RosParticipant& participant, const std::string& topic, TopicUse use) {
    const auto reader = participant.reader(topic, ros_type<Message>(), use);
    if (!reader) return reader.error();
    return Reader(*reader);
  }
  /// Hands what has come, at most kAtOnce, to `handle(message, written)`: `written` is UTC of the writer's clock.
  template <class Handle>
  void take(Handle handle) {
    std::array<void*, kAtOnce> samples{};
    std::array<dds_sample_info_t, kAtOnce> infos{};
    const int taken = dds_take(reader_, samples.data(), infos.data(), kAtOnce, kAtOnce);
    for (std::size_t i = 0; static_cast<int>(i) < taken; ++i)
      if (infos[i].valid_data) handle(*static_cast<const Message*>(samples[i]), Duration{infos[i].source_timestamp});
    if (taken > 0) (void)dds_return_loan(reader_, samples.data(), taken);
  }

 private:
  static constexpr std::size_t kAtOnce = 16;
  explicit Reader(dds_entity_t reader) : reader_(reader) {}
  dds_entity_t reader_;
};

}  // namespace cairn::ros
