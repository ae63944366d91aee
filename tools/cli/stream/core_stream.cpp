// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/stream/core_stream.hpp"

#include "onboard/app/live/stop_signal.hpp"

namespace cairn::cli {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(100);

Error gone(const std::filesystem::path& socket) {
  if (socket.filename() == "command.sock")
    return {Errc::kInvalidConfig,
            "this socket takes commands and tells nothing of the robot",
            socket.string(),
            {},
            "use " + (socket.parent_path() / "robot.sock").string()};
  return {Errc::kLinkDown, "the core is gone", socket.string(), {}, "or it has clients enough"};
}

}  // namespace

Result<void> read_core(const std::filesystem::path& socket, const client::SubscribeMessage& wants,
                       const std::function<Result<bool>(client::StreamMessage&)>& take,
                       const std::function<Result<bool>()>& idle, std::uint64_t* lost) {
  app::catch_stop_signals();
  auto stream = client::RobotStream::connect(socket, wants);
  if (!stream) return stream.error();
  while (!app::stop_requested()) {
    auto message = stream->next(kStep);
    if (!message) return at(socket.string(), message.error());
    if (lost != nullptr) *lost = stream->lost();
    if (std::holds_alternative<client::CoreGone>(*message)) return gone(socket);
    const bool nothing = std::holds_alternative<std::monostate>(*message);
    const auto goes_on = nothing ? Result<bool>(true) : take(*message);
    if (!goes_on) return goes_on.error();
    if (!*goes_on) return {};
    const auto patient = idle();
    if (!patient) return patient.error();
    if (!*patient) return {};
  }
  return {};
}

}  // namespace cairn::cli
