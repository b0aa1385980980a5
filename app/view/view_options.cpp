#include "app/view/view_options.h"

#include <CLI/CLI.hpp>

namespace stiffscope::app {

void addViewOptions(CLI::App& app, ViewArguments& arguments) {
  app.footer(keysText());
  ViewOptions& options = arguments.options;
  app.add_option("CAMPAIGN", options.campaign, "campaign folder or its campaign.xml")->required();
  app.add_option("--method", options.method, "cp, pp or dpp to predict by; without it as in the report");
  app.add_option("--step", arguments.step, "load step to identify from and to start with; without it the heaviest");
  app.add_option("--pose", options.pose, "posture to start with; without it the one with the median displacement");
  app.add_option("--magnification", arguments.magnification, "of the vectors; without it one that suits all postures");
  app.add_option("--view", arguments.view, "front, side, top or oblique")->capture_default_str();
  app.add_option("--point", options.point, "reflector whose numbers to show, P10 say, or Pwrist");
  app.add_flag("--dark", options.dark, "dark background");
  app.add_option("--size", arguments.size, "width and height of the window in pixels")
      ->expected(2)
      ->capture_default_str();
  app.add_option("--screenshot", options.screenshot, "draw once in the window, write this PNG file and end");
}

}  // namespace stiffscope::app
