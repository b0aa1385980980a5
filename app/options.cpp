#include "app/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <system_error>

#include "app/output.h"
#include "core/io/input_error.h"
#include "core/io/numbers.h"

namespace stiffscope::app {

std::vector<identification::Method> methodsNamed(const std::string& name) {
  if (name == "all") return {identification::kMethods.begin(), identification::kMethods.end()};
  if (name == "cp") return {identification::Method::complete_pose};
  if (name == "pp") return {identification::Method::partial_pose};
  if (name == "dpp") return {identification::Method::decoupled_partial_pose};
  throw io::InputError({"--method"}, name,
                       "expected cp, pp, dpp or all" + io::nearestNameHint(name, {"cp", "pp", "dpp", "all"}));
}

calibration::JointAngles jointAnglesNamed(const std::string& name) {
  if (name == "reported") return calibration::JointAngles::reported;
  if (name == "commanded") return calibration::JointAngles::commanded;
  throw io::InputError({"--angles"}, name,
                       "expected reported or commanded" + io::nearestNameHint(name, {"reported", "commanded"}));
}

void requireNoCampaign(const std::filesystem::path& folder, const std::string& expectation) {
  std::error_code none;
  if (!std::filesystem::exists(folder / "campaign.xml", none)) return;
  throw std::runtime_error(folder.string() + ": not written: it holds a campaign; " + expectation);
}

namespace {

std::string whyEmpty(const std::string& value) { return value.empty() ? "expected a value; it is empty" : ""; }

std::string whyNotFinite(const std::string& value) {
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  return std::isfinite(number) && end == value.c_str() + value.size() ? ""
                                                                      : "'" + value + "': expected a finite number";
}

std::string whyNotInteger(const std::string& value) {
  return io::parseInteger(value) ? "" : "'" + value + "': expected a whole number within +-2147483647";
}

std::string whyNotUnsigned(const std::string& value) {
  std::uint64_t number = 0;
  const char* const end = value.data() + value.size();
  const auto [stopped, error] = std::from_chars(value.data(), end, number);
  return error == std::errc() && stopped == end
             ? ""
             : "'" + value + "': expected a whole number from 0 to 18446744073709551615";
}

}  // namespace

void checkOptionValues(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands(nullptr)) {
    checkOptionValues(*command);  // `import` has commands of its own
    for (CLI::Option* option : command->get_options()) {
      const std::string type = option->get_type_name();
      if (option->get_type_size() == 0) continue;  // a flag
      option->check(whyEmpty, "");
      if (type.starts_with("FLOAT")) option->check(whyNotFinite, "");
      if (type.starts_with("INT")) option->check(whyNotInteger, "");
      if (type.starts_with("UINT")) option->check(whyNotUnsigned, "");
    }
  }
}

std::optional<int> loadStepNamed(const std::string& step, const std::string& also) {
  if (step.empty()) return std::nullopt;
  const std::optional<int> number = io::parseInteger(step);
  if (!number) {
    throw io::InputError(
        {"--step"}, step,
        (also.empty() ? "expected the number of one load step" : "expected a load step's number") + also);
  }
  return number;
}

JointVector anglesGiven(const std::string& option, const std::vector<double>& angles) {
  if (angles.size() < static_cast<std::size_t>(kFewestJoints) || angles.size() > static_cast<std::size_t>(kMostJoints))
    throw io::InputError({option}, fmt::format("{}", fmt::join(angles, ",")),
                         fmt::format("expected the angles of all joints, {} to {}", kFewestJoints, kMostJoints));
  return JointVector::Map(angles.data(), static_cast<Eigen::Index>(angles.size()));
}

void requireJointCount(const std::string& option, const std::vector<double>& angles, int joints) {
  if (angles.empty() || angles.size() == static_cast<std::size_t>(joints)) return;
  throw io::InputError({option}, fmt::format("{}", fmt::join(angles, ",")),
                       fmt::format("expected {} angles, one for each joint of the machine", joints));
}

namespace {

/// The command that was named, the innermost of `import campaign`, or the program itself.
const CLI::App& chosen(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : chosen(*commands.front());
}

/// "import campaign "; nothing where no command was named.
std::string commandWords(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? "" : commands.front()->get_name() + " " + commandWords(*commands.front());
}

std::string hintFor(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  for (const CLI::App* command : app.get_subcommands(nullptr)) known.push_back(command->get_name());
  return io::nearestNameHint(word, known);
}

/// Whether the word, which the program itself does not know, is an option of one of its commands.
bool optionOfCommands(const CLI::App& app, const std::string& word) {
  if (app.remaining().empty()) return false;
  const std::string name = word.substr(0, word.find('='));
  const auto commands = app.get_subcommands(nullptr);
  return name.starts_with("--") && std::any_of(commands.begin(), commands.end(), [&](const CLI::App* command) {
           return command->get_option_no_throw(name) != nullptr;
         });
}

}  // namespace

int explainUsageError(const CLI::App& app, const CLI::ParseError& error) {
  std::string message = error.what();
  const std::vector<std::string> unknown = chosen(app).remaining().empty() ? app.remaining() : chosen(app).remaining();
  if (!unknown.empty()) {
    message = optionOfCommands(app, unknown.front())
                  ? fmt::format("'{}' is an option of commands and belongs after the command's name", unknown.front())
                  : "'" + unknown.front() + "' is not known" + hintFor(chosen(app), unknown.front());
  }
  // Of the options that take none; values of the others are looked at before they are converted.
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) message += ": expected no value";
  const std::string program = app.get_name();
  constexpr std::size_t kLongest = 1000;
  std::fprintf(stderr, "%s: %s; see %s %s--help\n", program.c_str(), io::oneLine(message, kLongest).c_str(),
               program.c_str(), commandWords(app).c_str());
  return kBadInput;
}

}  // namespace stiffscope::app
