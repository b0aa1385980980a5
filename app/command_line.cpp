#include "app/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "app/options.h"
#include "app/output.h"
#include "app/terminal.h"
#include "core/io/input_error.h"

namespace stiffscope::app {

namespace {

/// `help`, `help COMMAND`, `help import campaign`: what --help prints.
void addHelp(CLI::App& app, Run& run) {
  const auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("help", "What a command does and its options");
  command->add_option("COMMAND", *words, "the command, with its own where it has some (import campaign)");
  command->callback([words, &app, &run] {
    run = [words, &app] {
      const CLI::App* about = &app;
      std::string above;  // "stiffscope import": what the usage of `help import campaign` begins with, as of --help
      for (const std::string& word : *words) {
        const CLI::App* inner = nullptr;
        std::vector<std::string> known;
        for (const CLI::App* one : about->get_subcommands(nullptr)) {
          known.push_back(one->get_name());
          if (one->get_name() == word) inner = one;
        }
        if (inner == nullptr) {
          throw io::InputError({"help"}, word, "expected a command" + io::nearestNameHint(word, known));
        }
        above += (above.empty() ? "" : " ") + about->get_name();
        about = inner;
      }
      printText(about->help(above));
      return kDone;
    };
  });
}

}  // namespace

std::unique_ptr<CLI::App> commandLine(Run& run) {
  auto made =
      std::make_unique<CLI::App>("Joint stiffness of industrial robots from laser-tracker campaigns", "stiffscope");
  CLI::App& app = *made;
  app.set_version_flag("--version", "stiffscope " STIFFSCOPE_VERSION);
  app.require_subcommand(0, 1);
  addInit(app, run);
  addImport(app, run);
  addAudit(app, run);
  addFit(app, run);
  addFrames(app, run);
  addIdentify(app, run);
  addCalibrate(app, run);
  addCompensate(app, run);
  addStiffness(app, run);
  addExport(app, run);
  addCompare(app, run);
  addPlan(app, run);
  addDiagnose(app, run);
  addFleet(app, run);
  addBlind(app, run);
  addSimulate(app, run);
  addReport(app, run);
  addView(app, run);
  addHelp(app, run);
  addMannerOptions(app);
  checkOptionValues(app);
  return made;
}

int runCommandLine(int count, char** words) {
  Run run;
  const std::unique_ptr<CLI::App> made = commandLine(run);
  CLI::App& app = *made;
  try {
    app.parse(count, words);
  } catch (const CLI::Success& asked) {  // --help, --version
    std::ostringstream text;
    const int status = app.exit(asked, text, text);
    printBytes(text.str());
    return status;
  } catch (const CLI::ParseError& error) {
    return explainUsageError(app, error);
  }
  if (!run) {
    std::fprintf(stderr, "%s", app.help().c_str());
    return kBadInput;
  }
  const auto commands = app.get_subcommands();
  const Progress progress(commands.empty() ? "" : commands.front()->get_name());
  return run();
}

}  // namespace stiffscope::app
