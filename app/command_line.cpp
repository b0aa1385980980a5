#include "app/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/options.h"
#include "app/output.h"

namespace stiffscope::app {

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
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return explainUsageError(app, error);
  }
  if (!run) {
    std::fprintf(stderr, "%s", app.help().c_str());
    return kBadInput;
  }
  return run();
}

}  // namespace stiffscope::app
