// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/top_command.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>

#include "tools/cli/top/live_client.hpp"
#include "tools/cli/top/render.hpp"

namespace cairn::cli {
namespace {

constexpr Duration kPatience = std::chrono::seconds(5);  // the core speaks once per second

struct TopArguments {
  std::filesystem::path socket;
  bool once = false, json = false;
};

int size_of_terminal(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  int size = 0;
  if (text == nullptr || std::from_chars(text, text + std::string_view(text).size(), size).ec != std::errc{})
    return otherwise;
  return size >= 20 && size <= 1000 ? size : otherwise;
}

void show(const LiveView& view, const TopArguments& a) {
  if (a.json) {
    std::cout << to_line(view) << std::flush;
    return;
  }
  const bool terminal = ::isatty(STDOUT_FILENO) != 0;
  const Screen screen{size_of_terminal("COLUMNS", 110), size_of_terminal("LINES", 24) - 1, terminal};
  std::string text = terminal && !a.once ? "\x1b[H" : "";
  for (const std::string& line : render(view, screen)) text += line + (terminal ? "\x1b[K\n" : "\n");
  if (terminal && !a.once) text += "\x1b[J";
  std::cout << text << std::flush;
}

int watch(const TopArguments& a) {
  auto client = LiveClient::connect(a.socket);
  if (!client) return fail(client.error());
  if (!a.once && !a.json && ::isatty(STDOUT_FILENO) != 0) std::cout << "\x1b[2J";
  for (;;) {
    const auto line = client->next(kPatience);
    if (!line) return fail(line.error());
    if (!*line)
      return fail({Errc::kLinkDown, "the core says nothing", a.socket.string(), {}, "its housekeeping hangs"});
    const auto view = parse_line(**line);
    if (!view) return fail(view.error());
    show(*view, a);
    if (a.once) return kDone;
    if (!std::cout) return kDone;  // whoever read is gone
  }
}

}  // namespace

void add_top_command(Commands& commands) {
  auto* sub = commands.app.add_subcommand("top", "a running core, live: stages, budgets, mode, faults, events");
  auto a = std::make_shared<TopArguments>();
  sub->add_option("--socket", a->socket, "where the core serves its live view")->default_val("/run/cairn/live.sock");
  sub->add_flag("--once", a->once, "one view, and done");
  sub->add_flag("--json", a->json, "the lines as they come");
  sub->callback([&commands, a] { commands.job = [a] { return watch(*a); }; });
}

}  // namespace cairn::cli
