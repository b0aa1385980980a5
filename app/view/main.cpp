#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>

#include "app/options.h"
#include "app/view/view_window.h"
#include "app/view/viewer.h"
#include "core/io/input_error.h"

namespace stiffscope::app {

namespace {

struct Words {
  std::string view = "oblique";
  double magnification = 0;
  int step = 0;
  std::vector<int> size{1280, 860};
};

render::View viewNamed(const std::string& name) {
  if (name == "front") return render::View::Front;
  if (name == "side") return render::View::Side;
  if (name == "top") return render::View::Top;
  if (name == "oblique") return render::View::Oblique;
  throw io::InputError(
      {"--view"}, name,
      "expected front, side, top or oblique" + io::nearestNameHint(name, {"front", "side", "top", "oblique"}));
}

render::Size sizeOf(const std::vector<int>& words) {
  const render::Size size{words[0], words[1]};
  if (size.width < 480 || size.height < 320 || size.width > 8000 || size.height > 8000) {
    throw io::InputError({"--size"}, std::to_string(size.width) + " " + std::to_string(size.height),
                     "expected 480 320 to 8000 8000 pixels");
  }
  return size;
}

int run(int count, char** arguments) {
  CLI::App app("The arm of a campaign with its deflection vectors, in a window", "stiffscope-view");
  app.set_version_flag("--version", "stiffscope-view " STIFFSCOPE_VERSION);
  app.footer(keysText());
  ViewOptions options;
  Words words;
  app.add_option("CAMPAIGN", options.campaign, "campaign folder or its campaign.xml")->required();
  app.add_option("--method", options.method, "cp, pp or dpp to predict by; without it as in the report");
  const CLI::Option* step = app.add_option(
      "--step", words.step, "load step to identify from and to start with; without it the heaviest");
  app.add_option("--pose", options.pose,
                 "posture to start with; without it the one with the median displacement");
  const CLI::Option* magnification = app.add_option("--magnification", words.magnification,
                                                    "of the vectors; without it one that suits all postures");
  app.add_option("--view", words.view, "front, side, top or oblique")->capture_default_str();
  app.add_option("--point", options.point, "reflector whose numbers to show, P10 say, or Pwrist");
  app.add_flag("--dark", options.dark, "dark background");
  app.add_option("--size", words.size, "width and height of the window in pixels")
      ->expected(2)
      ->capture_default_str();
  app.add_option("--screenshot", options.screenshot, "draw once in the window, write this PNG file and end");
  try {
    app.parse(count, arguments);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return explainUsageError(app, error);
  }
  options.view = viewNamed(words.view);
  options.size = sizeOf(words.size);
  if (step->count() > 0) options.step = words.step;
  if (magnification->count() > 0) {
    if (!std::isfinite(words.magnification) || words.magnification <= 0) {
      throw io::InputError({"--magnification"}, magnification->results().front(), "expected a number above 0");
    }
    options.magnification = words.magnification;
  }
  return viewCampaign(options);
}

}  // namespace

}  // namespace stiffscope::app

// The only place that catches and prints.
int main(int count, char** words) {
  try {
    return stiffscope::app::run(count, words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stiffscope-view: %s\n", error.what());
    return 2;
  }
}
