#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/computations.h"
#include "app/figures/path_figures.h"
#include "app/options.h"
#include "app/prediction.h"
#include "core/campaign/joint_reading.h"
#include "core/compensation/compensate.h"
#include "core/interchange/taught_program.h"
#include "core/io/input_error.h"
#include "core/io/numbers.h"
#include "core/io/read_file.h"
#include "core/io/units.h"
#include "core/io/write_file.h"
#include "core/robot/inverse_kinematics.h"
#include "core/toolpath/compensate_path.h"
#include "reports/csv/motion_csv.h"
#include "reports/json/json.h"
#include "reports/text/text.h"

// `compensate` of a robot's program and of a path of the tool.

namespace stiffscope::app {

namespace {

void warnOf(const std::vector<std::string>& warnings, const Outlet& outlet) {
  for (const std::string& warning : warnings) outlet.warn(warning);
}

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

/// The load at each of a program's targets.
void addTargetLoads(const MotionRequest& request, Prediction& prediction,
                    std::vector<compensation::PostureToCompensate>& targets, const Outlet& outlet) {
  const std::vector<std::string> kAxes{"cell", "base_link"};
  const bool in_base = !request.wrench_axes.empty() && placeOf(request.wrench_axes, kAxes, "--wrench-axes") == 1;
  if (in_base && request.tool.empty())
    throw io::InputError({"--wrench-axes"}, request.wrench_axes, "expected --tool, too: the wrench acts at its tip");
  std::vector<compensation::NamedReading> readings;
  if (!request.wrenches.empty()) {
    std::vector<std::string> warnings;
    readings = compensation::readWrenches(request.wrenches, warnings);
    warnOf(warnings, outlet);
  }
  for (compensation::PostureToCompensate& target : targets) {
    Vector6d wrench = sixOf(request.wrench);
    if (!request.wrenches.empty()) {
      const auto own =
          std::find_if(readings.begin(), readings.end(), [&](const auto& one) { return one.id == target.id; });
      if (own == readings.end())
        throw io::InputError({request.wrenches, 0, "pose"}, target.id,
                             "expected a wrench of each joint target; of this "
                             "one there is none");
      wrench = own->wrench_in_cell;
    }
    if (!in_base) {
      target.wrench_in_cell = wrench;
      continue;
    }
    const Eigen::Matrix3d& to_r0 = prediction.arm().geometry.r0_from_base_link.linear();
    target.load =
        effects::FlangeLoad{frameOf(request.tool).translation(), to_r0 * wrench.head<3>(), to_r0 * wrench.tail<3>()};
  }
}

/// How far the digits of a program move P_TCP, at most, m.
double roundingOf(const interchange::TaughtProgram& program, const campaign::JointConvention& convention,
                  Prediction& prediction, const std::vector<compensation::CompensatedPosture>& rows) {
  const robot::Robot& arm = prediction.arm().geometry.arm;
  const auto tcpAt = [&](const JointVector& q) -> Eigen::Vector3d {
    return robot::flangeAt(arm, robot::postureAt(arm, q)) * prediction.arm().tcp_in_flange;
  };
  double most = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].solved) continue;
    const double unit = io::kDegree * std::pow(10.0, -interchange::decimalsOfTarget(program, i));
    const JointVector written =
        convention.figures(rows[i].commands).unaryExpr([&](double figure) { return std::round(figure / unit) * unit; });
    most = std::max(most, (tcpAt(convention.angles(written)) - tcpAt(rows[i].commands)).norm());
  }
  return most;
}

}  // namespace

int compensateProgram(const MotionRequest& request, const CampaignSource& source, const Outlet& outlet) {
  if (request.out.empty()) throw io::InputError({"--program"}, request.program, "expected --out, too");
  if (request.wrench.empty() == request.wrenches.empty())
    throw io::InputError({"--program"}, request.program,
                         "expected the load: --wrench for all targets, or --wrenches by their names");
  interchange::TaughtProgram program;
  // The machine says how many joints a target has; identifying it takes long and comes last.
  const CampaignSource with_program{source.name, [&] {
                                      auto opened = source.open();
                                      program = interchange::readTaughtProgram(request.program,
                                                                               opened->campaign.robot.joints());
                                      return opened;
                                    }};
  Prediction prediction(with_program, request.prediction);
  const campaign::JointConvention convention(prediction.campaign().joint_readings,
                                             prediction.campaign().robot.joints());
  std::vector<compensation::PostureToCompensate> targets;
  for (const interchange::JointSample& sample : program.log.samples)
    targets.push_back({sample.name, convention.angles(sample.figures)});
  addTargetLoads(request, prediction, targets, outlet);
  const std::vector<compensation::CompensatedPosture> rows = prediction.compensate(targets);
  std::vector<std::optional<JointVector>> figures;
  for (const compensation::CompensatedPosture& row : rows)
    figures.push_back(row.solved ? std::optional<JointVector>(convention.figures(row.commands)) : std::nullopt);
  if (compensation::summaryOf(rows).compensated > 0) {
    io::requireNotRead(request.out);
    io::writeFileWhole(request.out, interchange::withFigures(program, figures));
  }
  const double rounding = roundingOf(program, convention, prediction, rows);
  return prediction.deliver(
      rows,
      [&](const auto&) {
        return reports::withProgram(
            reports::compensationJson(prediction.campaign(), prediction.method(), rows, prediction.known()), program,
            request.out, rows, rounding);
      },
      [&](const auto& cautions) {
        return reports::compensationText(prediction.campaign(), prediction.method(), rows, prediction.known(), cautions,
                                         prediction.weighsWhatHides()) +
               reports::programText(program, request.out, rows, rounding);
      },
      outlet);
}

namespace {

/// What is to be done, but for what the campaign says of it.
toolpath::PathJob pathJob(const MotionRequest& request, const Outlet& outlet) {
  if (request.tool.empty())
    throw io::InputError({"--path"}, request.path, "expected --tool, too: where the tool's tip is in the flange");
  toolpath::PathJob job;
  std::vector<std::string> warnings;
  job.path = toolpath::readToolPath(request.path, warnings);
  warnOf(warnings, outlet);
  job.flange_from_tool = frameOf(request.tool);
  job.base_from_workpiece = frameOf(request.workpiece);
  job.turn_free = job.path.turn_free || request.turn_free;
  if (!request.start.empty()) job.joints.start = anglesGiven("--start", request.start) * io::kDegree;
  if (!request.cutting.empty()) job.load.cutting = cuttingOf(request.cutting);
  const int loads = int(job.path.has_wrenches) + int(!request.wrench.empty()) + int(!request.cutting.empty());
  if (loads != 1)
    throw io::InputError(
        {"--path"}, request.path,
        fmt::format("expected the process load once: fx_n to mz_nm in the path, --wrench or --cutting; {}",
                    loads == 0 ? "there is none" : "there is more than one"));
  job.load.constant = sixOf(request.wrench);
  if (!request.wrench_axes.empty()) {
    if (job.load.cutting)
      throw io::InputError({"--wrench-axes"}, request.wrench_axes,
                           "expected no axes: those of --cutting are the feed's");
    const std::vector<std::string> known(toolpath::kWrenchAxesNames.begin(), toolpath::kWrenchAxesNames.end());
    job.load.axes = static_cast<toolpath::WrenchAxes>(placeOf(request.wrench_axes, known, "--wrench-axes"));
  }
  return job;
}

}  // namespace

int compensatePath(const MotionRequest& request, const CampaignSource& source, const Outlet& outlet) {
  toolpath::PathJob job = pathJob(request, outlet);
  const CampaignSource counted{source.name, [&] {
                                 auto opened = source.open();
                                 requireJointCount("--start", request.start, opened->campaign.robot.joints());
                                 return opened;
                               }};
  Prediction prediction(counted, request.prediction);
  const campaign::Campaign& campaign = prediction.campaign();
  if (job.joints.start) {
    const campaign::JointConvention convention(campaign.joint_readings, campaign.robot.joints());
    job.joints.start = convention.angles(*job.joints.start);
  }
  const toolpath::CompensatedPath path = toolpath::compensatePath(prediction.arm(), job);
  const std::vector<compensation::CompensatedPosture> rows = path.postures();
  if (!request.out.empty()) {
    io::requireNotRead(request.out);
    io::writeFileWhole(request.out, reports::pathCsv(prediction.campaign(), path));
  }
  if (!request.picture.empty()) {
    io::requireNotRead(request.picture);
    if (const auto picture = pathPicture(prediction.campaign(), path)) {
      const std::vector<std::uint8_t> png = render::encodePng(*picture);
      io::writeFileWhole(request.picture, std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
    } else {
      outlet.warn(request.picture + ": not drawn: of no pose a deflection is predicted");
    }
  }
  return prediction.deliver(
      rows,
      [&](const auto&) {
        return reports::pathJson(prediction.campaign(), prediction.method(), job, path, prediction.known());
      },
      [&](const auto& cautions) {
        return reports::pathText(prediction.campaign(), prediction.method(), job, path, prediction.known(), cautions);
      },
      outlet);
}

}  // namespace stiffscope::app
