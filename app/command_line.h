#pragma once

#include <functional>
#include <memory>
#include <string>

namespace CLI {
class App;
}

namespace stiffscope::app {

/// What a parsed command line asks for; returns the exit status.
using Run = std::function<int()>;

/// Each adds its command to the command line and puts what it does into `run` when it is chosen.
void addAudit(CLI::App& app, Run& run);
void addFit(CLI::App& app, Run& run);
void addInit(CLI::App& app, Run& run);
void addImport(CLI::App& app, Run& run);
void addFrames(CLI::App& app, Run& run);
void addIdentify(CLI::App& app, Run& run);
void addCompensate(CLI::App& app, Run& run);
void addCalibrate(CLI::App& app, Run& run);
void addStiffness(CLI::App& app, Run& run);
void addExport(CLI::App& app, Run& run);
void addCompare(CLI::App& app, Run& run);
void addPlan(CLI::App& app, Run& run);
void addDiagnose(CLI::App& app, Run& run);
void addFleet(CLI::App& app, Run& run);
void addBlind(CLI::App& app, Run& run);
void addSimulate(CLI::App& app, Run& run);
void addReport(CLI::App& app, Run& run);
void addView(CLI::App& app, Run& run);

/// All of them, in the order of `--help`, with the program's name, description and version.
std::unique_ptr<CLI::App> commandLine(Run& run);

/// Parses the command line and runs the command. Returns the exit status; throws what the command throws.
int runCommandLine(int count, char** words);

}  // namespace stiffscope::app
