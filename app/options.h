#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/calibration/unloaded_day.h"
#include "core/identification/identify.h"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace stiffscope::app {

/// The methods that `--method` names: cp, pp, dpp or all. Throws InputError with the nearest known name.
std::vector<identification::Method> methodsNamed(const std::string& name);

/// Throws std::runtime_error where `folder` holds a campaign.xml, for what is not to be written among a day's tables;
/// ends in `expectation`.
void requireNoCampaign(const std::filesystem::path& folder, const std::string& expectation);

/// How a folder that is not written over is told of, by commands that have --replace.
inline constexpr const char* kOrReplace = "expected another folder, or --replace to write over it";

/// The joint angles that `--angles` names: reported or commanded. Throws InputError with the nearest known name.
calibration::JointAngles jointAnglesNamed(const std::string& name);

/// Refuses, for every option of every command, what its type would take and nobody means: an empty value, a number that
/// is not finite, and of a whole number one that is negative or does not fit.
void checkOptionValues(CLI::App& app);

/// The load step that `--step` names; empty where it was not given. Throws InputError, naming the option, for
/// anything but a whole number; `also` is what the command takes besides, as its words say it (", or all").
std::optional<int> loadStepNamed(const std::string& step, const std::string& also = {});

/// Joint angles as an option gives them, in its unit. Throws InputError, naming the option, where they are of no
/// machine: fewer than kFewestJoints, more than kMostJoints.
JointVector anglesGiven(const std::string& option, const std::vector<double>& angles);

/// Throws InputError, naming the option, for angles that are given and are not one for each joint of the machine.
void requireJointCount(const std::string& option, const std::vector<double>& angles, int joints);

/// One line to standard error for a command line that cannot be understood; a word that is not known gets the
/// nearest one that is. Returns the exit status.
int explainUsageError(const CLI::App& app, const CLI::ParseError& error);

}  // namespace stiffscope::app
