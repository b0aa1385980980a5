#include "app/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/command.h"
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

/// One line for a usage error; a word that is not known gets the nearest one that is.
int explain(const CLI::App& app, const CLI::ParseError& error) {
  std::string message = error.what();
  const std::vector<std::string> unknown = chosen(app).remaining().empty() ? app.remaining() : chosen(app).remaining();
  if (!unknown.empty()) {
    message = "'" + unknown.front() + "' is not known" + hintFor(chosen(app), unknown.front());
  }
  std::fprintf(stderr, "stiffscope: %s; see stiffscope %s%s--help\n", message.c_str(),
               app.get_subcommands().empty() ? "" : chosen(app).get_name().c_str(),
               app.get_subcommands().empty() ? "" : " ");
  return kBadInput;
}

}  // namespace

int runCommandLine(int count, char** words) {
  CLI::App app("Joint stiffness of industrial robots from laser-tracker campaigns", "stiffscope");
  app.set_version_flag("--version", "stiffscope " STIFFSCOPE_VERSION);
  app.require_subcommand(0, 1);
  Run run;
  addAudit(app, run);
  addFit(app, run);
  addFrames(app, run);
  addIdentify(app, run);
  addCompensate(app, run);
  addDiagnose(app, run);
  addSimulate(app, run);
  addReport(app, run);
  addBlind(app, run);
  try {
    app.parse(count, words);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return explain(app, error);
  }
  if (!run) {
    std::fprintf(stderr, "%s", app.help().c_str());
    return kBadInput;
  }
  return run();
}

}  // namespace stiffscope
