// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/import/import.hpp"
#include "drivers/velodyne/models.hpp"
#include "drivers/velodyne/packet.hpp"
#include "drivers/velodyne/transport/pcap_source.hpp"

namespace cairn::recording {
namespace {

using velodyne::PcapSource;

Result<std::unique_ptr<PcapSource>> open_capture(const ImportOptions& options) {
  PcapSource::Options wanted;
  wanted.ports = {options.data_port, options.position_port};
  return PcapSource::open(options.source, wanted);
}

/// What the first packets tell.
struct Found {
  std::int64_t start_utc_ns = 0;
  std::uint8_t product = 0;
};

/// Looks for the first data packet; kNotFound when there is none.
Result<Found> look_into(const ImportOptions& options) {
  auto opened = open_capture(options);
  if (!opened) return opened.error();
  GuardedSource capture(std::move(*opened), options.source.string());
  Packet packet;
  std::optional<std::int64_t> start;
  for (auto poll = capture.next(packet, {}); poll && *poll != Poll::kEnd; poll = capture.next(packet, {})) {
    if (*poll == Poll::kTimeout) continue;
    if (!start) start = packet.arrival.time_since_epoch().count();
    if (packet.channel != options.data_port || packet.bytes.size() != velodyne::kDataBytes) continue;
    return Found{*start, std::to_integer<std::uint8_t>(packet.bytes[velodyne::kProductOffset])};
  }
  return Error{Errc::kNotFound,
               "the capture holds no Velodyne data packets",
               options.source.string(),
               {},
               "looked for 1206 bytes to UDP port " + std::to_string(options.data_port)};
}

/// The model that was asked for and the one that the sensor says must agree.
Result<std::string> choose_model(const ImportOptions& options, std::uint8_t product) {
  const velodyne::Model* told = velodyne::find_model(product);
  const velodyne::Model* asked = options.model.empty() ? told : velodyne::find_model(options.model);
  if (asked == nullptr && options.model.empty())
    return Error{Errc::kUnsupported,
                 "the sensor's product byte is unknown",
                 options.source.string(),
                 {},
                 std::to_string(product) + "; name the model: " + velodyne::model_names()};
  if (asked == nullptr)
    return Error{Errc::kInvalidConfig, "unknown sensor model", options.model, {}, "known: " + velodyne::model_names()};
  if (told != nullptr && asked != told)
    return Error{Errc::kInvalidConfig,
                 "the capture is of another sensor model",
                 options.source.string(),
                 {},
                 "asked for " + options.model + ", the packets say " + std::string(told->name)};
  return std::string(asked->name);
}

Result<RecordingWriter> create_writer(const ImportOptions& options, const std::string& model, std::int64_t start) {
  Recording recording;
  recording.robot = options.robot;
  recording.start_utc_ns = start;
  recording.notes = "imported from a capture file; the time line is the capture's own clock";
  SourceEntry lidar{.id = "lidar", .kind = kVelodyne, .file = "lidar.pcap", .frame = "lidar", .model = model};
  lidar.data_port = options.data_port;
  lidar.position_port = options.position_port;
  recording.sources.push_back(std::move(lidar));
  return RecordingWriter::create(options.out, recording);
}

/// Takes the verdicts that can be given by now.
void judge(StampGuard& guard, std::optional<Time>& first, ImportReport& report) {
  while (const auto verdict = guard.pop()) {
    if (verdict->absurd) continue;
    if (!first) report.first = *(first = verdict->stamp);
    report.last = verdict->stamp;
  }
}

Result<void> copy_packets(PcapSource& capture, RecordingWriter& writer, const ImportOptions& options,
                          ImportReport& report) {
  Packet packet;
  StampGuard guard;
  std::optional<Time> first;
  for (;;) {
    const auto poll = capture.next(packet, {});
    if (!poll) {
      ++report.damaged;
      report.damage.push_back(poll.error());
    } else if (*poll == Poll::kEnd) {
      guard.end();
      judge(guard, first, report);
      report.absurd_stamps = guard.found();
      report.absurd_stamps_note =
          guard.to_error(options.source.string(), "they are kept, and set aside when the recording is read");
      return {};
    } else if (*poll == Poll::kPacket) {
      if (auto written = writer.write(packet); !written) return written;
      guard.push(packet.arrival, capture.record_offset());
      judge(guard, first, report);
      ++report.items;
      report.bytes += packet.bytes.size();
      if (options.progress) options.progress(report.items);
      if (options.stop && options.stop()) return import_interrupted(options);
    }
  }
}

}  // namespace

Result<ImportReport> import_velodyne_pcap(const ImportOptions& options) {
  const auto found = look_into(options);
  if (!found) return found.error();
  const auto model = choose_model(options, found->product);
  if (!model) return model.error();
  auto capture = open_capture(options);
  if (!capture) return capture.error();
  auto writer = create_writer(options, *model, found->start_utc_ns);
  if (!writer) return writer.error();
  ImportReport report;
  report.model = *model;
  if (auto copied = copy_packets(**capture, *writer, options, report); !copied) return copied.error();
  if (auto closed = writer->close(); !closed) return closed.error();
  const auto& counters = (*capture)->counters();
  if (counters.truncated_tail || counters.malformed > 0) {
    report.damaged += counters.malformed + (counters.truncated_tail ? 1 : 0);
    report.damage.push_back({Errc::kTruncated,
                             "the capture holds records that cannot be read",
                             options.source.string(),
                             {},
                             std::to_string(counters.malformed) + " malformed" +
                                 (counters.truncated_tail ? ", and it ends inside its last record" : "")});
  }
  return report;
}

}  // namespace cairn::recording
