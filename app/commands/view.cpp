#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <unistd.h>

#include "app/command_line.h"

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

}  // namespace

void addView(CLI::App& app, Run& run) {
  CLI::App* command =
      app.add_subcommand("view", "The arm with its deflection vectors, in a window (stiffscope-view)");
  // Everything after it, --help too, is the window's.
  command->set_help_flag();
  command->prefix_command();
  command->allow_extras();
  command->callback(
      [command, &run] { run = [words = command->remaining()] { return becomeViewer(words); }; });
}

}  // namespace stiffscope::app
