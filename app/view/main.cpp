#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>

#include "app/options.h"
#include "app/view/view_options.h"
#include "app/view/view_window.h"
#include "core/io/input_error.h"

namespace stiffscope::app {

namespace {

render::View viewNamed(const std::string& name) {
  if (name == "front") return render::View::front;
  if (name == "side") return render::View::side;
  if (name == "top") return render::View::top;
  if (name == "oblique") return render::View::oblique;
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
  CLI::App app(kViewDescription, "stiffscope-view");
  app.set_version_flag("--version", "stiffscope-view " STIFFSCOPE_VERSION);
  ViewArguments words;
  addViewOptions(app, words);
  try {
    app.parse(count, arguments);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return explainUsageError(app, error);
  }
  ViewOptions options = words.options;
  options.view = viewNamed(words.view);
  options.size = sizeOf(words.size);
  if (const CLI::Option& step = *app.get_option("--step"); step.count() > 0) options.step = words.step;
  if (const CLI::Option& magnification = *app.get_option("--magnification"); magnification.count() > 0) {
    if (!std::isfinite(words.magnification) || words.magnification <= 0) {
      throw io::InputError({"--magnification"}, magnification.results().front(), "expected a number above 0");
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
