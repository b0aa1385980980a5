#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "app/options.h"
#include "app/output.h"
#include "app/view/view_material.h"
#include "app/view/view_options.h"
#include "app/view/viewer.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/write_file.h"
#include "core/numerics/parallel.h"
#include "core/preparation/prepare.h"
#include "render/arm_window.h"
#include "render/image.h"
#include "reports/page/html.h"

namespace stiffscope::app {

namespace {

void savePicture(const render::Image& image, const std::filesystem::path& file) {
  io::requireNotRead(file);
  const auto png = render::encodePng(image);
  io::writeFileWhole(file, {reinterpret_cast<const char*>(png.data()), png.size()});
}

/// A file that is not there yet, in the folder where the program was started.
std::filesystem::path freeFile(std::string name) {
  for (char& c : name) {
    if (c == '/' || static_cast<unsigned char>(c) < ' ') c = '_';
  }
  std::filesystem::path file = fmt::format("stiffscope-{}.png", name);
  for (int number = 2; std::filesystem::exists(file); ++number) {
    file = fmt::format("stiffscope-{}-{}.png", name, number);
  }
  return file;
}

void say(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

ViewWindow handlesOf(render::ArmWindow& window) {
  ViewWindow handles;
  handles.look = [&](render::View view) { window.look(view); };
  handles.turn = [&](double about_vertical, double towards) { window.turn(about_vertical, towards); };
  handles.zoom = [&](double factor) { window.zoom(factor); };
  handles.save = [&](const std::string& name) {
    try {
      const std::filesystem::path file = freeFile(name);
      savePicture(window.picture(), file);
      say(file.string() + "\n");
      return "saved " + file.string();
    } catch (const std::exception& error) {  // a full or foreign folder is no reason to close the window
      return std::string("not saved: ") + error.what();
    }
  };
  handles.close = [&] { window.close(); };
  handles.say = say;
  return handles;
}

/// Shows the numbers of the point that is named by its id ("P10") or as it is labelled ("Pwrist").
void pickNamed(Viewer& viewer, const std::string& name) {
  const render::ArmPose pose = viewer.scene().poses.front();
  std::vector<std::string> names;
  for (const render::ScenePoint& target : pose.targets) names.push_back(reports::plain(target.label));
  if (pose.wrist) names.push_back(reports::plain(pose.wrist->label));
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return viewer.pick(i);
  }
  throw io::InputError({"--point"}, name, "not a point of this picture" + io::nearestNameHint(name, names));
}

/// Opens the window and shows the campaign until it is closed, or once for a screenshot. Returns the exit
/// status; throws NoDisplay, InputError, and what reading and drawing throw.
int viewCampaign(const ViewOptions& options) {
  render::ArmWindow window(options.size);  // first: without a display there is no point in reading
  const campaign::Campaign campaign = preparation::prepareCampaign(openCampaign(options.campaign)).campaign;
  OpenedMaterial opened = openMaterial(campaign, options);
  Viewer viewer(std::move(opened.by_method), opened.first, options.magnification, handlesOf(window));
  viewer.settings().dark = options.dark;
  viewer.settings().keys_listed = viewer.settings().keys_work = options.screenshot.empty();
  if (!options.point.empty()) pickNamed(viewer, options.point);
  window.look(options.view);
  window.show(viewer.scene(), viewer.title());
  if (!options.screenshot.empty()) {
    savePicture(window.picture(), options.screenshot);
    return kDone;
  }
  render::ArmWindow::Events events;
  events.key = [&](const std::string& key) {
    viewer.press(key);
    window.show(viewer.scene(), viewer.title());
  };
  events.pick = [&](std::optional<std::size_t> point) {
    viewer.pick(point);
    window.show(viewer.scene(), viewer.title());
  };
  window.run(events);
  return kDone;
}

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
  stiffscope::numerics::sumAlikeEverywhere();
  try {
    return stiffscope::app::run(count, words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stiffscope-view: %s\n", error.what());
    return 2;
  }
}
