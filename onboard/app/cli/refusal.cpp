// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/cli/refusal.hpp"

#include <CLI/CLI.hpp>
#include <vector>

#include "onboard/app/cli/nearest.hpp"

namespace cairn::app {
namespace {

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App* s) { return !s->get_name().empty(); }))
    names.push_back(sub->get_name());
  return names;
}

/// Hidden ones are left out.
std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::string meant(const std::string& word, const std::vector<std::string>& names) {
  const auto name = nearest(word, names);
  return name ? "; did you mean \"" + *name + "\"?" : ".";
}

/// `command` is the whole name of `app`, as it was called.
std::string unknown(const CLI::App& app, const std::string& command, std::string word) {
  if (word.starts_with('-')) {
    word = word.substr(0, word.find('='));
    return "`" + command + "` has no option \"" + word + "\"" + meant(word, options_of(app));
  }
  const std::vector<std::string> commands = commands_of(app);
  if (commands.empty()) return "`" + command + "` takes no further argument, and got \"" + word + "\".";
  return "`" + command + "` has no command \"" + word + "\"" + meant(word, commands);
}

}  // namespace

std::string refusal_of(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* at = &app;
  std::string command = app.get_name();
  for (;;) {
    // An unknown word goes before all else: what is said to be missing is probably what it was meant to be.
    if (const auto words = at->remaining(); !words.empty())
      return unknown(*at, command, words.front()) + " `" + command + " --help` lists what there is.";
    const auto chosen = at->get_subcommands();
    if (chosen.empty()) break;
    at = chosen.front();
    command += " " + at->get_name();
  }
  return std::string(error.what()) + ". `" + command + " --help` explains it.";
}

}  // namespace cairn::app
