#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/command_line.h"
#include "app/computations.h"
#include "app/output.h"
#include "core/io/input_error.h"
#include "core/io/read_points.h"
#include "metrology/robust_fit.h"
#include "reports/json/fit_json.h"
#include "reports/text/text.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

namespace {

const std::vector<std::string> kShapes{"line", "plane", "circle", "sphere", "cylinder"};
const std::vector<std::string> kStrategies{"full", "plane-first"};

void requireKnown(const std::string& what, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  std::string list;
  for (const std::string& one : known) list += (list.empty() ? "" : &one == &known.back() ? " or " : ", ") + one;
  throw io::InputError({what}, name, "expected " + list + io::nearestNameHint(name, known));
}

template <class FitFunction>
reports::ShapeFit fitWith(const FitFunction& fitTo, const std::string& shape, const metrology::MeasuredPoints& points,
                          bool robust) {
  if (!robust) return {shape, points.points.size(), fitTo(points), std::nullopt};
  const auto found = metrology::fitRobustly(points, fitTo);
  return {shape, points.points.size() - found.rejected.size(), found.fit,
          reports::Snooping{found.family_level, found.critical_w, found.rejected}};
}

reports::ShapeFit fitShape(const std::string& shape, metrology::CircleStrategy strategy,
                           const metrology::MeasuredPoints& points, bool robust) {
  const auto circle = [strategy](const metrology::MeasuredPoints& readings) {
    return metrology::fitCircle(readings, strategy);
  };
  if (shape == "line") return fitWith(metrology::fitLine, shape, points, robust);
  if (shape == "plane") return fitWith(metrology::fitPlane, shape, points, robust);
  if (shape == "circle") return fitWith(circle, shape, points, robust);
  if (shape == "sphere") return fitWith(metrology::fitSphere, shape, points, robust);
  return fitWith(metrology::fitCylinder, shape, points, robust);
}

}  // namespace

int fitPoints(const FitRequest& request, const std::string& name,
              const std::function<std::vector<Eigen::Vector3d>()>& points, const Outlet& outlet) {
  requireKnown("SHAPE", request.shape, kShapes);
  if (!request.strategy.empty()) {
    requireKnown("--strategy", request.strategy, kStrategies);
    if (request.shape != "circle") {
      throw io::InputError({"--strategy"}, request.strategy,
                           "expected with circle only: other shapes have no second one");
    }
  }
  const auto strategy =
      request.strategy == "plane-first" ? metrology::CircleStrategy::plane_first : metrology::CircleStrategy::full;
  const reports::ShapeFit fitted = fitShape(request.shape, strategy, {points(), {}}, request.robust);
  outlet.deliver([&] { return reports::fitJson(fitted); }, [&] { return reports::fitText(fitted); });
  if (fitted.quality().determined) return kDone;
  outlet.explain(name + ": " + request.shape + ": " + reports::words(fitted.quality().reason));
  return kNotUsable;
}

void addFit(CLI::App& app, Run& run) {
  struct FitArguments {
    FitRequest request;
    std::string file, json;
  };
  const auto arguments = std::make_shared<FitArguments>();
  CLI::App* command = app.add_subcommand("fit", "A line, plane, circle, sphere or cylinder through points of a file");
  command->add_option("SHAPE", arguments->request.shape, "line, plane, circle, sphere or cylinder")->required();
  command->add_option("FILE", arguments->file, "points, x y z a line; a first line with only their count is accepted")
      ->required();
  command->add_option(
      "--strategy", arguments->request.strategy,
      "of a circle: full (distances in space; without it this) or plane-first (a plane, then a circle in it)");
  command->add_flag("--robust", arguments->request.robust,
                    "leave out and list the readings that the others contradict (Baarda's w-test)");
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  command->callback([arguments, &run] {
    run = [arguments] {
      return fitPoints(
          arguments->request, arguments->file, [&] { return io::readPoints(arguments->file); },
          commandLineOutlet(arguments->json));
    };
  });
}

}  // namespace stiffscope::app
