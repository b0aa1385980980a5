#include "app/usage_error.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/output.h"
#include "core/input/nearest_name.h"

namespace stiffscope {

namespace {

/// The command that was named, or the program itself.
const CLI::App& chosen(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : *commands.front();
}

std::string hintFor(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  for (const CLI::App* command : app.get_subcommands(nullptr)) known.push_back(command->get_name());
  return nearestNameHint(word, known);
}

}  // namespace

int explainUsageError(const CLI::App& app, const CLI::ParseError& error) {
  std::string message = error.what();
  const std::vector<std::string> unknown =
      chosen(app).remaining().empty() ? app.remaining() : chosen(app).remaining();
  if (!unknown.empty()) {
    message = "'" + unknown.front() + "' is not known" + hintFor(chosen(app), unknown.front());
  }
  const std::string program = app.get_name();
  std::fprintf(stderr, "%s: %s; see %s %s%s--help\n", program.c_str(), message.c_str(), program.c_str(),
               app.get_subcommands().empty() ? "" : chosen(app).get_name().c_str(),
               app.get_subcommands().empty() ? "" : " ");
  return kBadInput;
}

}  // namespace stiffscope
