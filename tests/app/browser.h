#pragma once

#include <filesystem>
#include <sstream>
#include <string>

#include "tests/app/command.h"

namespace stiffscope {

/// Whether a shell finds this program.
inline bool installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

/// Runs a command of the shell; what it prints.
inline Ran runShell(const std::string& line, const std::filesystem::path& scratch) {
  const std::string out = (scratch / "shell.out").string(), err = (scratch / "shell.err").string();
  const int raw = std::system(("( " + line + " ) >'" + out + "' 2>'" + err + "'").c_str());
  return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, contentsOf(out), contentsOf(err)};
}

/// Chromium without a window, with a profile of its own in `scratch`.
inline Ran runChromium(const std::string& options, const std::string& words, const std::filesystem::path& scratch) {
  return runShell("timeout 100 chromium --headless --no-sandbox --enable-unsafe-swiftshader --no-first-run " + options +
                      " --user-data-dir='" + (scratch / "profile").string() + "' " + words,
                  scratch);
}

/// Without WebGL where the machine has none for it; its console goes to standard error.
inline Ran runBrowser(const std::string& words, const std::filesystem::path& scratch) {
  return runChromium("--disable-gpu --hide-scrollbars --disable-background-networking --enable-logging=stderr", words,
                     scratch);
}

/// With WebGL by software, as long as a scene takes to come.
inline Ran runBrowserWithWebGl(const std::string& words, const std::filesystem::path& scratch) {
  return runChromium(
      "--use-gl=angle --use-angle=swiftshader --ignore-gpu-blocklist --window-size=1400,1000 "
      "--virtual-time-budget=60000",
      words, scratch);
}

/// What a page wrote to the console, out of what the browser logs. The graphics driver says there what it did slowly,
/// which hangs on the machine and not on the page.
inline std::string writtenToConsole(const std::string& log) {
  std::istringstream lines(log);
  std::string written;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("CONSOLE") != std::string::npos && line.find("GL Driver Message") == std::string::npos)
      written += line + "\n";
  }
  return written;
}

}  // namespace stiffscope
