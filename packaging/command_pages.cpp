// Writes the manual pages and the bash completion of both programs from their own command lines.
// stiffscope_pages DIR: stiffscope.1, stiffscope-COMMAND.1 for each command, stiffscope-view.1, and in DIR/completions
// the files stiffscope and stiffscope-view.

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <cctype>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "app/command_line.h"
#include "app/view/view_options.h"
#include "core/io/write_file.h"

namespace {

using Commands = std::vector<const CLI::App*>;

Commands commandsOf(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Text as roff takes it.
std::string roff(const std::string& text) {
  std::string escaped;
  bool line_starts = true;
  for (const char c : text) {
    if (line_starts && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
    line_starts = c == '\n';
  }
  return escaped;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// "-h, --help TEXT" with its markup.
std::string optionHeading(const CLI::Option& option) {
  if (option.get_positional()) return fmt::format("\\fI{}\\fR", roff(option.get_name(true)));
  std::string names;
  for (const std::string& name : option.get_snames()) names += fmt::format("\\fB\\-{}\\fR, ", roff(name));
  for (const std::string& name : option.get_lnames()) names += fmt::format("\\fB\\-\\-{}\\fR, ", roff(name));
  names.resize(names.size() - 2);
  if (option.get_type_size() > 0) names += fmt::format(" \\fI{}\\fR", roff(option.get_type_name()));
  return names;
}

/// Those that --help shows.
std::vector<const CLI::Option*> optionsOf(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
}

std::string optionText(const CLI::Option& option) {
  std::string text = roff(option.get_description());
  if (!option.get_default_str().empty()) text += fmt::format(" (default: {})", roff(option.get_default_str()));
  return text;
}

std::string optionsText(const CLI::App& app) {
  std::string text;
  for (const bool positional : {true, false}) {
    for (const CLI::Option* option : optionsOf(app)) {
      if (option->get_positional() != positional) continue;
      text += fmt::format(".TP\n{}\n{}\n", optionHeading(*option), optionText(*option));
    }
  }
  return text;
}

std::string synopsis(const std::string& words, const CLI::App& app) {
  std::string text = fmt::format(".B {}\n", roff(words));
  if (!commandsOf(app).empty()) text += "\\fICOMMAND\\fR ";
  text += "[\\fIOPTIONS\\fR]";
  for (const CLI::Option* option : optionsOf(app)) {
    if (option->get_positional()) text += fmt::format(" \\fI{}\\fR", roff(option->get_name(true)));
  }
  return text + "\n";
}

/// What belongs to the command itself: description, options, and the commands that it has.
std::string body(const std::string& words, const CLI::App& app) {
  std::string text =
      ".SH SYNOPSIS\n" + synopsis(words, app) + ".SH DESCRIPTION\n" + roff(app.get_description()) + ".\n";
  if (!app.get_footer().empty()) text += ".PP\n.nf\n" + roff(app.get_footer()) + "\n.fi\n";
  if (const std::string options = optionsText(app); !options.empty()) text += ".SH OPTIONS\n" + options;
  const Commands commands = commandsOf(app);
  if (!commands.empty()) text += ".SH COMMANDS\n";
  for (const CLI::App* command : commands)
    text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(command->get_name()), roff(command->get_description()));
  return text;
}

std::string page(const std::string& name, const std::string& description, const std::string& body,
                 const std::string& see_also) {
  return fmt::format(
      ".TH {} 1 \"\" \"stiffscope {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n{}"
      ".SH EXIT STATUS\n.TP\n0\ndone\n.TP\n1\ndone, but the result does not serve its purpose\n.TP\n2\nbad input\n"
      ".SH SEE ALSO\n{}\n",
      upper(name), STIFFSCOPE_VERSION, roff(name), roff(description), body, see_also);
}

/// Of a command; those that it has itself follow one after the other.
std::string commandPage(const CLI::App& command) {
  const std::string words = "stiffscope " + command.get_name();
  std::string text = body(words, command);
  for (const CLI::App* inner : commandsOf(command)) {
    text += fmt::format(".SH {}\n{}.\n.PP\n", upper(words + " " + inner->get_name()), roff(inner->get_description())) +
            synopsis(words + " " + inner->get_name(), *inner) + optionsText(*inner);
  }
  return page("stiffscope-" + command.get_name(), command.get_description(), text, ".BR stiffscope (1)");
}

std::string longOptions(const CLI::App& app) {
  std::string words;
  for (const CLI::Option* option : optionsOf(app)) {
    for (const std::string& name : option->get_lnames()) words += " --" + name;
  }
  return words.empty() ? words : words.substr(1);
}

std::string commandNames(const CLI::App& app) {
  std::string words;
  for (const CLI::App* command : commandsOf(app)) words += " " + command->get_name();
  return words.empty() ? words : words.substr(1);
}

constexpr const char* kComplete = R"({0}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} options= commands=
{1}
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  elif [[ -n $commands ]]; then
    COMPREPLY=($(compgen -W "$commands" -- "$word"))
  else
    compopt -o filenames
    COMPREPLY=($(compgen -f -- "$word"))
  fi
}}
complete -F {0} {2}
)";

/// Commands, then a command's options and files; `import` has commands once more.
std::string completion(const CLI::App& app, const CLI::App& view) {
  std::string cases;
  for (const CLI::App* command : commandsOf(app)) {
    const CLI::App& known = command->get_name() == "view" ? view : *command;
    if (commandsOf(known).empty()) {
      cases += fmt::format("      {}) options=\"{}\" ;;\n", command->get_name(), longOptions(known));
      continue;
    }
    cases += fmt::format("      {0})\n        case ${{COMP_WORDS[2]}} in\n", command->get_name());
    for (const CLI::App* inner : commandsOf(known))
      cases += fmt::format("          {}) ((COMP_CWORD > 2)) && options=\"{}\" ;;\n", inner->get_name(),
                           longOptions(*inner));
    cases += fmt::format("        esac\n        ((COMP_CWORD == 2)) && options=\"{}\" commands=\"{}\"\n        ;;\n",
                         longOptions(known), commandNames(known));
  }
  const std::string body = fmt::format(
      "  if ((COMP_CWORD == 1)); then\n    options=\"{}\" commands=\"{}\"\n  else\n    case ${{COMP_WORDS[1]}} in\n{}"
      "    esac\n  fi",
      longOptions(app), commandNames(app), cases);
  return fmt::format(kComplete, "_stiffscope", body, "stiffscope");
}

void writePages(const std::filesystem::path& folder) {
  namespace app = stiffscope::app;
  app::Run run;
  const auto program = app::commandLine(run);
  CLI::App view(app::kViewDescription, "stiffscope-view");
  view.set_version_flag("--version", "");
  app::ViewArguments arguments;
  app::addViewOptions(view, arguments);

  std::filesystem::create_directories(folder / "completions");
  const auto write = [&](const std::string& name, const std::string& text) {
    stiffscope::io::writeFileWhole(folder / name, text);
  };
  std::string others = ".BR stiffscope\\-view (1)";
  for (const CLI::App* command : commandsOf(*program)) {
    if (command->get_name() == "view") continue;
    others += fmt::format(",\n.BR stiffscope\\-{} (1)", command->get_name());
    write("stiffscope-" + command->get_name() + ".1", commandPage(*command));
  }
  write("stiffscope.1", page("stiffscope", program->get_description(), body("stiffscope", *program), others));
  write("stiffscope-view.1",
        page("stiffscope-view", view.get_description(), body("stiffscope-view", view), ".BR stiffscope (1)"));
  write("completions/stiffscope", completion(*program, view));
  write("completions/stiffscope-view",
        fmt::format(kComplete, "_stiffscope_view", fmt::format("  options=\"{}\"", longOptions(view)),
                    "stiffscope-view"));
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) return 2;
  try {
    writePages(words[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stiffscope_pages: %s\n", error.what());
    return 2;
  }
}
