// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/recording/send_command.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "drivers/recording/paced_source.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/velodyne/transport/udp_sender.hpp"
#include "hal/clock.hpp"
#include "onboard/app/live/stop_signal.hpp"

namespace cairn::cli {
namespace {

struct SendArguments {
  std::filesystem::path recording;
  std::string to = "127.0.0.1";
  int port_offset = 0;
  double rate = 1;
};

/// Sends what is a LiDAR's until the end; returns the number of datagrams.
Result<std::uint64_t> send_all(Source& source, const recording::Recording& recorded, velodyne::UdpSender& wire,
                               int port_offset) {
  std::uint64_t sent = 0;
  for (Packet packet; !app::stop_requested();) {
    const auto polled = source.next(packet, std::chrono::milliseconds(50));
    if (!polled) {
      std::fprintf(stderr, "%s\n", to_string(polled.error()).c_str());
      continue;
    }
    if (*polled == Poll::kEnd) break;
    if (*polled == Poll::kTimeout) continue;
    if (recorded.sources[static_cast<std::size_t>(packet.source)].kind != recording::kVelodyne) continue;
    const auto port = static_cast<std::uint16_t>(packet.channel + port_offset);
    if (const auto done = wire.send(packet.payload(), port); !done) return done.error();
    ++sent;
  }
  return sent;
}

int send(const SendArguments& a) {
  auto reader = recording::RecordingReader::open(a.recording);
  if (!reader) return app::fail(reader.error());
  auto wire = velodyne::UdpSender::open(a.to);
  if (!wire) return app::fail(wire.error());
  app::catch_stop_signals();
  const LiveClock clock;
  recording::PacedSource paced(**reader, clock, recording::live_waiter(), a.rate);
  const auto sent = send_all(paced, (*reader)->recording(), **wire, a.port_offset);
  if (!sent) return app::fail(sent.error());
  std::printf("%llu datagrams to %s\n", static_cast<unsigned long long>(*sent), a.to.c_str());
  if (*sent > 0) return app::kDone;
  return app::fail({Errc::kNotFound,
                    "not one LiDAR datagram is in the recording",
                    a.recording.string(),
                    {},
                    "sweeps without packets cannot be sent"});
}

}  // namespace

void add_send_command(app::Commands& commands) {
  auto* sub =
      commands.app.add_subcommand("send", "sends the LiDAR datagrams of a recording over UDP, as fast as they came");
  auto a = std::make_shared<SendArguments>();
  sub->add_option("recording,--recording", a->recording, "folder of a recording: once, with or without the name")
      ->option_text("FOLDER")  // not REQUIRED twice: either one is enough
      ->required();
  sub->add_option("--to", a->to, "IPv4 address of the robot")->default_val("127.0.0.1");
  sub->add_option("--port-offset", a->port_offset, "added to the recorded ports")->check(CLI::Range(-60000, 60000));
  sub->add_option("--rate", a->rate, "factor on the speed; 2 is twice as fast")->check(CLI::Range(0.01, 100.0));
  sub->callback([&commands, a] { commands.job = [a] { return send(*a); }; });
}

}  // namespace cairn::cli
