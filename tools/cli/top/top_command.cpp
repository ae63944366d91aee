// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/top/top_command.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "tools/cli/top/live_client.hpp"
#include "tools/cli/top/render.hpp"

namespace cairn::cli {
namespace {

constexpr Duration kLongestSilence = std::chrono::seconds(5);  // the core speaks once per second

struct TopArguments {
  std::filesystem::path socket;
  bool once = false, json = false;
};

/// Of the terminal on stdout; where it is none, what a wide page holds.
Screen screen_now() {
  winsize size{};
  const bool terminal = ::isatty(STDOUT_FILENO) != 0;
  if (!terminal || ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0)
    return {.columns = 120, .rows = 200};
  return {.columns = size.ws_col, .rows = std::max(2, static_cast<int>(size.ws_row)) - 1, .colour = true};
}

void show(const app::LiveView& view, const TopArguments& a) {
  if (a.json) {
    std::cout << app::to_line(view) << std::flush;
    return;
  }
  const Screen screen = screen_now();
  const bool in_place = screen.colour && !a.once;
  std::string text = in_place ? "\x1b[H" : "";
  for (const std::string& line : render(view, screen)) text += line + (in_place ? "\x1b[K\n" : "\n");
  if (in_place) text += "\x1b[J";
  std::cout << text << std::flush;
}

int watch(const TopArguments& a) {
  auto client = LiveClient::connect(a.socket);
  if (!client) return app::fail(client.error());
  if (!a.once && !a.json && ::isatty(STDOUT_FILENO) != 0) std::cout << "\x1b[2J";
  for (;;) {
    const auto line = client->next(kLongestSilence);
    if (!line) return app::fail(line.error());
    if (!*line)
      return app::fail({Errc::kLinkDown, "the core says nothing", a.socket.string(), {}, "its watch task hangs"});
    const auto view = app::parse_line(**line);
    if (!view) return app::fail(view.error());
    show(*view, a);
    if (a.once) return app::kDone;
    if (!std::cout) return app::kDone;  // whoever read is gone
  }
}

}  // namespace

void add_top_command(app::Commands& commands) {
  auto* sub =
      commands.app.add_subcommand("top", "shows a running core: mode, faults, tasks with their deadlines, events");
  auto a = std::make_shared<TopArguments>();
  sub->add_option("--socket", a->socket, "socket of the core: its --live-view")->default_val("/run/cairn/live.sock");
  sub->add_flag("--once", a->once, "show one view and end");
  sub->add_flag("--json", a->json, "print the lines of JSON as they come");
  sub->callback([&commands, a] { commands.job = [a] { return watch(*a); }; });
}

}  // namespace cairn::cli
