// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cairn::peer_link {

/// From the signal to the end of the process, at most; systemd is told to kill after two.
inline constexpr unsigned kEndPatience_s = 1;

/// From now on SIGINT and SIGTERM ask the process for its end. If it is still there after kEndPatience_s, it leaves
/// without waiting for its threads, with exit code 0 and a line on stderr: Cyclone DDS joins threads that a cap on
/// traffic or a flood of datagrams holds up. Takes SIGALRM.
void catch_end_signals();
/// Such a signal has come. Any thread.
[[nodiscard]] bool end_requested();

}  // namespace cairn::peer_link
