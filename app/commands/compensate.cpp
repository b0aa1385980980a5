#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

#include "app/command_line.h"
#include "app/figures/path_figures.h"
#include "app/identified.h"
#include "app/model.h"
#include "app/output.h"
#include "app/prepared.h"
#include "core/campaign/joint_reading.h"
#include "core/compensation/compensate.h"
#include "core/extended_model/effect_deflection.h"
#include "core/extended_model/extended_model.h"
#include "core/identification/identification.h"
#include "core/identification/known_stiffness.h"
#include "core/interchange/taught_program.h"
#include "core/io/input_error.h"
#include "core/io/numbers.h"
#include "core/io/read_file.h"
#include "core/io/units.h"
#include "core/io/write_file.h"
#include "core/robot/inverse_kinematics.h"
#include "core/toolpath/compensate_path.h"
#include "reports/csv/motion_csv.h"
#include "reports/json/campaign_json.h"
#include "reports/json/identification_json.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/text/text.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::app {

namespace {

struct CompensateArguments {
  std::string campaign, postures, program, path, out, picture, json, method, step;
  std::string wrenches, wrench_axes;
  std::vector<double> wrench, tool, workpiece, start;
  std::vector<std::string> cutting;
  std::optional<double> load_sd_percent;
  bool turn_free = false, raw = false;
  ModelChoice model;
};

Vector6d sixOf(const std::vector<double>& values) {
  return values.empty() ? Vector6d(Vector6d::Zero()) : Vector6d(Vector6d::Map(values.data()));
}

/// x, y, z (mm) and roll, pitch, yaw (deg), as URDF has them.
Eigen::Isometry3d frameOf(const std::vector<double>& values) {
  const Vector6d six = sixOf(values);
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.translation() = six.head<3>() * io::kMillimetre;
  frame.linear() = robot::rotationFromRpy(six.tail<3>() * io::kDegree);
  return frame;
}

/// What `--cutting` says: NAME=VALUE each. Throws InputError, naming the option, for what does not make a cut.
toolpath::Cutting cuttingOf(const std::vector<std::string>& words) {
  struct Entry {
    const char* name;
    double toolpath::Cutting::*member;
    double unit, least, most;
    bool required, given;
  };
  constexpr double kLargest = 1e9;
  std::vector<Entry> entries{
      {"feed_mm", &toolpath::Cutting::feed, io::kMillimetre, 0.0, kLargest, true, false},
      {"depth_mm", &toolpath::Cutting::depth, io::kMillimetre, 0.0, kLargest, true, false},
      {"width_mm", &toolpath::Cutting::width, io::kMillimetre, 0.0, kLargest, true, false},
      {"diameter_mm", &toolpath::Cutting::diameter, io::kMillimetre, 0.0, kLargest, true, false},
      {"specific_force_n_mm2", &toolpath::Cutting::specific_force, 1e6, 0.0, kLargest, true, false},
      {"radial_ratio", &toolpath::Cutting::radial_ratio, 1.0, 0.0, 10.0, false, false},
      {"axial_ratio", &toolpath::Cutting::axial_ratio, 1.0, -10.0, 10.0, false, false}};
  std::vector<std::string> known{"up", "down"};
  for (const Entry& entry : entries) known.emplace_back(entry.name);
  toolpath::Cutting cutting;
  for (const std::string& word : words) {
    if (word == "up" || word == "down") {
      cutting.up = word == "up";
      continue;
    }
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const auto entry = std::find_if(entries.begin(), entries.end(), [&](const Entry& one) { return name == one.name; });
    if (entry == entries.end() || equals == std::string::npos)
      throw io::InputError(
          {"--cutting"}, word,
          fmt::format("expected NAME=VALUE of {}{}", fmt::join(known, ", "), io::nearestNameHint(name, known)));
    const io::ParsedNumber value = io::parseNumber(word.substr(equals + 1));
    if (!value.expectation.empty()) throw io::InputError({"--cutting"}, word, value.expectation);
    const bool positive = !entry->required || value.value > 0.0;
    if (!positive || value.value < entry->least || value.value > entry->most)
      throw io::InputError({"--cutting"}, word,
                           entry->required
                               ? "expected a number above 0"
                               : fmt::format("expected a number from {:g} to {:g}", entry->least, entry->most));
    cutting.*entry->member = value.value * entry->unit;
    entry->given = true;
  }
  for (const Entry& entry : entries) {
    if (entry.required && !entry.given)
      throw io::InputError({"--cutting"}, "", fmt::format("expected {}=VALUE, too", entry.name));
  }
  if (cutting.width > cutting.diameter)
    throw io::InputError({"--cutting"}, fmt::format("width_mm={:g}", cutting.width / io::kMillimetre),
                         "expected a width of cut no larger than diameter_mm");
  return cutting;
}

/// Where a name stands in a list. Throws InputError, naming the option, for one that does not.
std::size_t placeOf(const std::string& name, const std::vector<std::string>& known, const char* option) {
  const auto found = std::find(known.begin(), known.end(), name);
  if (found == known.end())
    throw io::InputError({option}, name,
                         fmt::format("expected {}{}", fmt::join(known, ", "), io::nearestNameHint(name, known)));
  return static_cast<std::size_t>(found - known.begin());
}

/// Everything that a prediction is made by.
class Predictor {
 public:
  explicit Predictor(const CompensateArguments& arguments)
      : prepared_(openPrepared(arguments.campaign, arguments.raw)),
        found_(identifiedBy(prepared_, arguments.campaign, arguments.model,
                            methodAndStep(arguments.method, arguments.step))) {
    // Every model that a prediction may come from takes what is known of joints that the day cannot see.
    estimates_.push_back(&found_.of_method().estimate);
    if (found_.improved)
      estimates_.push_back(&found_.improved->without.methods[static_cast<std::size_t>(found_.method)].estimate);
    for (identification::StiffnessEstimate* estimate : estimates_) {
      of_the_day_.push_back(*estimate);
      known_ = identification::completeByKnown(campaign().known_stiffness, *estimate);
    }
    const double load_sd =
        arguments.load_sd_percent ? 0.01 * *arguments.load_sd_percent : campaign().load_cell->gain_sigma;
    certainty_ = found_.improved ? compensation::certaintyOf(*found_.improved, found_.method, load_sd)
                                 : compensation::certaintyOf(found_.result(), found_.method, load_sd);
    if (found_.improved && extended_model::deflectsByEffects(found_.improved->effects))
      give_ = extended_model::effectDeflection(*found_.improved, found_.method);
  }
  Predictor(const Predictor&) = delete;
  Predictor& operator=(const Predictor&) = delete;

  const campaign::Campaign& campaign() const { return found_.campaign(prepared_); }
  identification::Method method() const { return found_.method; }
  int step() { return found_.result().step; }
  const std::vector<campaign::KnownStiffness>& known() const { return known_; }
  const frames::LoadingGeometry& geometry() { return found_.of_method().geometry; }
  const Eigen::Vector3d& tcpInFlange() { return found_.result().frames.tcp_in_flange; }
  toolpath::PathArm arm() {
    return {campaign(), geometry(), found_.of_method().estimate, give_ ? &*give_ : nullptr, &certainty_};
  }

  std::vector<compensation::CompensatedPosture> compensate(
      const std::vector<compensation::PostureToCompensate>& postures) {
    const toolpath::PathArm by = arm();
    return compensation::compensate(by.campaign, by.geometry, by.estimate, tcpInFlange(), postures, {}, by.with,
                                    by.certainty);
  }

  /// Hands on what a prediction came to, with what is said of every one of them.
  void deliver(const std::vector<compensation::CompensatedPosture>& rows,
               const std::function<reports::Json(const std::vector<std::string>& cautions)>& json,
               const std::function<std::string(const std::vector<std::string>& cautions)>& text,
               const std::string& json_file) {
    // Tables of stiffnesses are of the day.
    for (std::size_t i = 0; i < estimates_.size(); ++i) *estimates_[i] = of_the_day_[i];
    const identification::Identification& result = found_.result();
    const std::optional<identification::ShownFirst>& first = found_.shown_first;
    const std::vector<identification::Method> methods{found_.method};
    std::vector<std::string> cautions = reports::words(result.cautions);
    for (const Remark& caution : compensation::implausibleCommands(rows)) cautions.push_back(reports::words(caution));
    app::deliver(
        [&] {
          reports::Json document = json(cautions);
          document["shown_first"] = reports::shownFirstJson(first);
          document["cautions"] = cautions;
          if (found_.improved) document = reports::withEffects(std::move(document), *found_.improved, methods);
          return reports::withPreparation(std::move(document), prepared_.preparation);
        },
        [&] {
          return text(cautions) + (first ? reports::wrapped(reports::shownFirstWords(result, *first), 2) + "\n" : "") +
                 (found_.improved ? reports::extendedModelText(*found_.improved, methods) : "") +
                 reports::preparationText(prepared_.preparation);
        },
        json_file);
  }

 private:
  preparation::PreparedCampaign prepared_;
  Identified found_;
  std::vector<identification::StiffnessEstimate*> estimates_;
  std::vector<identification::StiffnessEstimate> of_the_day_;
  std::vector<campaign::KnownStiffness> known_;
  compensation::Certainty certainty_;
  std::optional<effects::EffectDeflection> give_;
};

int statusOf(const std::vector<compensation::CompensatedPosture>& rows) {
  return compensation::summaryOf(rows).mostRefused() ? kNotUsable : kDone;
}

int compensatePostures(const CompensateArguments& arguments) {
  Predictor predictor(arguments);
  std::vector<std::string> warnings;
  const std::vector<compensation::PostureToCompensate> asked =
      arguments.postures.empty() ? compensation::campaignPostures(predictor.campaign(), predictor.step())
                                 : compensation::readPostures(arguments.postures, warnings);
  printWarnings(warnings);
  const std::vector<compensation::CompensatedPosture> rows = predictor.compensate(asked);
  if (!arguments.out.empty()) {
    io::requireNotRead(arguments.out);
    io::writeFileWhole(arguments.out, reports::commandsCsv(predictor.campaign(), rows));
  }
  predictor.deliver(
      rows,
      [&](const auto&) {
        return reports::compensationJson(predictor.campaign(), predictor.method(), rows, predictor.known());
      },
      [&](const auto& cautions) {
        return reports::compensationText(predictor.campaign(), predictor.method(), rows, predictor.known(), cautions);
      },
      arguments.json);
  return statusOf(rows);
}

/// The load at each of a program's targets.
void addTargetLoads(const CompensateArguments& arguments, Predictor& predictor,
                    std::vector<compensation::PostureToCompensate>& targets) {
  const std::vector<std::string> kAxes{"cell", "base_link"};
  const bool in_base = !arguments.wrench_axes.empty() && placeOf(arguments.wrench_axes, kAxes, "--wrench-axes") == 1;
  if (in_base && arguments.tool.empty())
    throw io::InputError({"--wrench-axes"}, arguments.wrench_axes, "expected --tool, too: the wrench acts at its tip");
  std::vector<compensation::NamedReading> readings;
  if (!arguments.wrenches.empty()) {
    std::vector<std::string> warnings;
    readings = compensation::readWrenches(arguments.wrenches, warnings);
    printWarnings(warnings);
  }
  for (compensation::PostureToCompensate& target : targets) {
    Vector6d wrench = sixOf(arguments.wrench);
    if (!arguments.wrenches.empty()) {
      const auto own =
          std::find_if(readings.begin(), readings.end(), [&](const auto& one) { return one.id == target.id; });
      if (own == readings.end())
        throw io::InputError({arguments.wrenches, 0, "pose"}, target.id,
                             "expected a wrench of each joint target; of this "
                             "one there is none");
      wrench = own->wrench_in_cell;
    }
    if (!in_base) {
      target.wrench_in_cell = wrench;
      continue;
    }
    const Eigen::Matrix3d& to_r0 = predictor.geometry().r0_from_base_link.linear();
    target.load =
        effects::FlangeLoad{frameOf(arguments.tool).translation(), to_r0 * wrench.head<3>(), to_r0 * wrench.tail<3>()};
  }
}

/// How far the digits of a program move P_TCP, at most, m.
double roundingOf(const interchange::TaughtProgram& program, const campaign::JointConvention& convention,
                  Predictor& predictor, const std::vector<compensation::CompensatedPosture>& rows) {
  const robot::Robot& arm = predictor.geometry().arm;
  const auto tcpAt = [&](const Vector6d& q) -> Eigen::Vector3d {
    return robot::flangeAt(arm, robot::postureAt(arm, q)) * predictor.tcpInFlange();
  };
  double most = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].solved) continue;
    const double unit = io::kDegree * std::pow(10.0, -interchange::decimalsOfTarget(program, i));
    const Vector6d written =
        convention.figures(rows[i].commands).unaryExpr([&](double figure) { return std::round(figure / unit) * unit; });
    most = std::max(most, (tcpAt(convention.angles(written)) - tcpAt(rows[i].commands)).norm());
  }
  return most;
}

int compensateProgram(const CompensateArguments& arguments) {
  if (arguments.out.empty()) throw io::InputError({"--program"}, arguments.program, "expected --out, too");
  if (arguments.wrench.empty() == arguments.wrenches.empty())
    throw io::InputError({"--program"}, arguments.program,
                         "expected the load: --wrench for all targets, or --wrenches by their names");
  const interchange::TaughtProgram program = interchange::readTaughtProgram(arguments.program);
  Predictor predictor(arguments);
  const campaign::JointConvention convention(predictor.campaign().joint_readings);
  std::vector<compensation::PostureToCompensate> targets;
  for (const interchange::JointSample& sample : program.log.samples)
    targets.push_back({sample.name, convention.angles(sample.figures), {}});
  addTargetLoads(arguments, predictor, targets);
  const std::vector<compensation::CompensatedPosture> rows = predictor.compensate(targets);
  std::vector<std::optional<Vector6d>> figures;
  for (const compensation::CompensatedPosture& row : rows)
    figures.push_back(row.solved ? std::optional<Vector6d>(convention.figures(row.commands)) : std::nullopt);
  if (compensation::summaryOf(rows).compensated > 0) {
    io::requireNotRead(arguments.out);
    io::writeFileWhole(arguments.out, interchange::withFigures(program, figures));
  }
  const double rounding = roundingOf(program, convention, predictor, rows);
  predictor.deliver(
      rows,
      [&](const auto&) {
        return reports::withProgram(
            reports::compensationJson(predictor.campaign(), predictor.method(), rows, predictor.known()), program,
            arguments.out, rows, rounding);
      },
      [&](const auto& cautions) {
        return reports::compensationText(predictor.campaign(), predictor.method(), rows, predictor.known(), cautions) +
               reports::programText(program, arguments.out, rows, rounding);
      },
      arguments.json);
  return statusOf(rows);
}

/// What is to be done, but for what the campaign says of it.
toolpath::PathJob pathJob(const CompensateArguments& arguments) {
  if (arguments.tool.empty())
    throw io::InputError({"--path"}, arguments.path, "expected --tool, too: where the tool's tip is in the flange");
  toolpath::PathJob job;
  std::vector<std::string> warnings;
  job.path = toolpath::readToolPath(arguments.path, warnings);
  printWarnings(warnings);
  job.flange_from_tool = frameOf(arguments.tool);
  job.base_from_workpiece = frameOf(arguments.workpiece);
  job.turn_free = job.path.turn_free || arguments.turn_free;
  if (!arguments.start.empty()) job.joints.start = sixOf(arguments.start) * io::kDegree;
  if (!arguments.cutting.empty()) job.load.cutting = cuttingOf(arguments.cutting);
  const int loads = int(job.path.has_wrenches) + int(!arguments.wrench.empty()) + int(!arguments.cutting.empty());
  if (loads != 1)
    throw io::InputError(
        {"--path"}, arguments.path,
        fmt::format("expected the process load once: fx_n to mz_nm in the path, --wrench or --cutting; {}",
                    loads == 0 ? "there is none" : "there is more than one"));
  job.load.constant = sixOf(arguments.wrench);
  if (!arguments.wrench_axes.empty()) {
    if (job.load.cutting)
      throw io::InputError({"--wrench-axes"}, arguments.wrench_axes,
                           "expected no axes: those of --cutting are the feed's");
    const std::vector<std::string> known(toolpath::kWrenchAxesNames.begin(), toolpath::kWrenchAxesNames.end());
    job.load.axes = static_cast<toolpath::WrenchAxes>(placeOf(arguments.wrench_axes, known, "--wrench-axes"));
  }
  return job;
}

int compensatePath(const CompensateArguments& arguments) {
  const toolpath::PathJob job = pathJob(arguments);
  Predictor predictor(arguments);
  const toolpath::CompensatedPath path = toolpath::compensatePath(predictor.arm(), job);
  const std::vector<compensation::CompensatedPosture> rows = path.postures();
  if (!arguments.out.empty()) {
    io::requireNotRead(arguments.out);
    io::writeFileWhole(arguments.out, reports::pathCsv(predictor.campaign(), path));
  }
  if (!arguments.picture.empty()) {
    io::requireNotRead(arguments.picture);
    if (const auto picture = pathPicture(predictor.campaign(), path)) {
      const std::vector<std::uint8_t> png = render::encodePng(*picture);
      io::writeFileWhole(arguments.picture, std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
    } else {
      printWarnings({arguments.picture + ": not drawn: of no pose a deflection is predicted"});
    }
  }
  predictor.deliver(
      rows,
      [&](const auto&) {
        return reports::pathJson(predictor.campaign(), predictor.method(), job, path, predictor.known());
      },
      [&](const auto& cautions) {
        return reports::pathText(predictor.campaign(), predictor.method(), job, path, predictor.known(), cautions);
      },
      arguments.json);
  return statusOf(rows);
}

int compensateCampaign(const CompensateArguments& arguments) {
  requireTwoFiles(arguments.out, arguments.json);
  if (!arguments.program.empty()) return compensateProgram(arguments);
  if (!arguments.path.empty()) return compensatePath(arguments);
  return compensatePostures(arguments);
}

CLI::Option* addSix(CLI::App& command, const char* name, std::vector<double>& values, const char* what) {
  return command.add_option(name, values, what)->delimiter(',')->expected(6);
}

}  // namespace

void addCompensate(CLI::App& app, Run& run) {
  const auto arguments = std::make_shared<CompensateArguments>();
  CLI::App* command = app.add_subcommand("compensate", "Predicted deflection, and the joint commands that cancel it");
  command->add_option("CAMPAIGN", arguments->campaign, "campaign folder or its campaign.xml")->required();
  CLI::Option* postures = command->add_option(
      "--postures", arguments->postures,
      "CSV with pose, q1_deg..q6_deg and the load-cell reading fx_n..mz_nm expected there; without it the "
      "campaign's own");
  CLI::Option* program =
      command
          ->add_option("--program", arguments->program,
                       "a robot's program (.ls, .src, .dat, .mod): its joint targets are replaced, all else stays")
          ->excludes(postures);
  CLI::Option* path =
      command
          ->add_option(
              "--path", arguments->path,
              "CSV with pose, x_mm y_mm z_mm of the tool's tip, and i j k (axis, tip to spindle) or qw qx qy qz, "
              "perhaps fx_n..mz_nm on the tool and load_share, in the workpiece's frame")
          ->excludes(postures)
          ->excludes(program);
  command->add_option("--out", arguments->out, "write the commands to this file: CSV, or with --program the program");
  CLI::Option* wrench = addSix(*command, "--wrench", arguments->wrench,
                               "fx,fy,fz (N), mx,my,mz (Nm) on the tool at every target or pose");
  CLI::Option* wrenches = command
                              ->add_option("--wrenches", arguments->wrenches,
                                           "CSV with pose (the target's name in the program) and fx_n..mz_nm")
                              ->needs(program)
                              ->excludes(wrench);
  CLI::Option* axes = command->add_option(
      "--wrench-axes", arguments->wrench_axes,
      "of wrenches: with --program cell (as the load cell reads them; default) or base_link (at the tool's tip); with "
      "--path workpiece (default), tool, feed (along, left, up the tool) or base_link");
  CLI::Option* cutting =
      command
          ->add_option("--cutting", arguments->cutting,
                       "the load by milling: feed_mm (a revolution), depth_mm, width_mm, diameter_mm, "
                       "specific_force_n_mm2, perhaps radial_ratio, axial_ratio, up or down")
          ->type_name("NAME=VALUE,...")
          ->delimiter(',')
          ->needs(path)
          ->excludes(wrench);
  CLI::Option* tool =
      addSix(*command, "--tool", arguments->tool,
             "x,y,z (mm), roll,pitch,yaw (deg) of the tool's tip in the flange; its z leads out of the tool");
  addSix(*command, "--workpiece", arguments->workpiece,
         "x,y,z (mm), roll,pitch,yaw (deg) of the workpiece's frame in base_link; without it base_link")
      ->needs(path);
  command
      ->add_flag("--turn-free", arguments->turn_free,
                 "the tool may turn about its axis although the path has quaternions")
      ->needs(path);
  addSix(*command, "--start", arguments->start, "joint angles (deg) near the first pose: the branch to stay on")
      ->needs(path);
  command
      ->add_option("--load-sd-percent", arguments->load_sd_percent,
                   "standard uncertainty of the loads' size; without it that of the load cell's scale")
      ->check(CLI::Range(0.0, 100.0));
  command->add_option("--picture", arguments->picture, "draw the path and its deviations into this PNG file")
      ->needs(path);
  command->add_option("--method", arguments->method, "cp, pp or dpp; without it the one that identify shows first");
  command->add_option("--step", arguments->step, "load step to identify from");
  addModelOptions(*command, arguments->model);
  addRawOption(*command, arguments->raw);
  command->add_option("--json", arguments->json, "write the result to this file, - for standard output");
  // What postures have by themselves is refused beside them, not ignored.
  command->callback([=, &run] {
    const bool own_load = program->count() == 0 && path->count() == 0;
    for (const CLI::Option* option : {wrench, wrenches, axes, cutting, tool}) {
      if (own_load && option->count() > 0) throw CLI::ValidationError(option->get_name(), "needs --program or --path");
    }
    run = [arguments] { return compensateCampaign(*arguments); };
  });
}

}  // namespace stiffscope::app
