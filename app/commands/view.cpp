#include <unistd.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "app/command_line.h"
#include "app/output.h"
#include "app/view/view_options.h"

namespace stiffscope::app {

namespace {

/// The window is a program of its own, because GLX and OSMesa do not go into one; it stands beside this one.
int becomeViewer(std::vector<std::string> words) {
  const auto viewer = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "stiffscope-view";
  std::vector<char*> arguments{const_cast<char*>("stiffscope-view")};
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(viewer.c_str(), arguments.data());
  throw std::runtime_error("cannot start " + viewer.string() + ": " + std::strerror(errno) +
                           " (it is built where X11 and a VTK for X are there)");
}

bool asksForHelp(const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(),
                     [](const std::string& word) { return word == "--help" || word == "-h"; });
}

int printHelp() {
  CLI::App window(kViewDescription, "stiffscope view");
  ViewArguments arguments;
  addViewOptions(window, arguments);
  printText(window.help());
  return kDone;
}

}  // namespace

void addView(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("view", "The arm with its deflection vectors, in a window (stiffscope-view)");
  // Everything after it is the window's; help needs no window, nor the program that opens it.
  command->set_help_flag();
  command->prefix_command();
  command->allow_extras();
  command->callback([command, &run] {
    run = [words = command->remaining()] { return asksForHelp(words) ? printHelp() : becomeViewer(words); };
  });
}

}  // namespace stiffscope::app
