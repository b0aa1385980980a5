#pragma once

#include <string>
#include <vector>

#include "app/view/viewer.h"

namespace CLI {
class App;
}

namespace stiffscope::app {

inline constexpr const char* kViewDescription = "The arm of a campaign with its deflection vectors, in a window";

/// The words of a command line for the window. Those that `options` holds itself stand there.
struct ViewArguments {
  ViewOptions options;
  std::string view = "oblique";
  double magnification = 0;
  int step = 0;
  std::vector<int> size{1280, 860};
};

/// Adds the window's options, and its keys as the help's last lines. `arguments` must outlive the parsing.
void addViewOptions(CLI::App& app, ViewArguments& arguments);

}  // namespace stiffscope::app
