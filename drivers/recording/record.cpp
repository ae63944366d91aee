// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/record.hpp"

namespace cairn::recording {
namespace {

constexpr Duration kPollTimeout = std::chrono::milliseconds(50);
constexpr Duration kFlushPeriod = std::chrono::seconds(1);
constexpr int kMostWaiting = 10'000;  // packets when told to stop: several full socket buffers

class Recorder {
 public:
  Recorder(Source& source, const Clock& clock, RecordingWriter& writer, const RecordOptions& options)
      : source_(source), clock_(clock), writer_(writer), options_(options), start_(clock.now()), last_flush_(start_) {}

  Result<void> go() {
    for (;;) {
      const Time now = clock_.now();
      report_.length = now - start_;
      if ((options_.length && report_.length >= *options_.length) || (options_.stop && options_.stop()))
        return write_waiting(now);
      if (auto flushed = flush(now); !flushed) return flushed;
      const auto poll = source_.next(packet_, kPollTimeout);
      if (!poll) {
        note(poll.error());
      } else if (*poll == Poll::kEnd) {
        return {};
      } else if (*poll == Poll::kPacket) {
        if (auto written = writer_.write(packet_); !written) return written;
      }
    }
  }

  [[nodiscard]] RecordReport& report() { return report_; }

 private:
  /// What came before the end and waits in the sources' buffers.
  Result<void> write_waiting(Time end) {
    for (int left = kMostWaiting; left > 0; --left) {
      const auto poll = source_.next(packet_, Duration::zero());
      if (poll && *poll != Poll::kPacket) return {};
      if (!poll || packet_.arrival > end) continue;  // a sensor that fails must not cost what others hold
      if (auto written = writer_.write(packet_); !written) return written;
    }
    return {};
  }

  void note(const Error& error) {
    if (report_.source_errors++ == 0) report_.first_error = to_string(error);
  }

  Result<void> flush(Time now) {
    if (now - last_flush_ < kFlushPeriod) return {};
    last_flush_ = now;
    if (options_.on_second) options_.on_second(now - start_);
    return writer_.flush();
  }

  Source& source_;
  const Clock& clock_;
  RecordingWriter& writer_;
  const RecordOptions& options_;
  Time start_, last_flush_;
  Packet packet_;
  RecordReport report_;
};

}  // namespace

Result<RecordReport> record(Source& source, const Clock& clock, RecordingWriter& writer, const RecordOptions& options) {
  Recorder recorder(source, clock, writer, options);
  const auto done = recorder.go();
  const auto closed = writer.close();
  if (!done) return done.error();
  if (!closed) return closed.error();
  return std::move(recorder.report());
}

}  // namespace cairn::recording
