#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/calibration/calibrate.h"
#include "core/calibration/denavit_hartenberg.h"
#include "core/calibration/growth_from.h"
#include "core/io/units.h"
#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/calibration_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"

namespace stiffscope::page {

namespace {

constexpr double kMillidegree = 1e-3 * io::kDegree;

/// "y", "−z", or its coordinates.
std::string directionWords(const Eigen::Vector3d& direction) {
  constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  constexpr double kAlong = 1.0 - 1e-6;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(direction[k]) > kAlong)
      return std::string(direction[k] < 0.0 ? "−" : "") + kNames[static_cast<std::size_t>(k)];
  }
  return fmt::format("({}, {}, {})", reports::fixed(direction.x(), 2), reports::fixed(direction.y(), 2),
                     reports::fixed(direction.z(), 2));
}

/// Against the URDF's axes.
reports::Table axesTable(const calibration::Calibration& calibration) {
  const calibration::ArmFit& fit = calibration.geometry().fit;
  reports::Table table{
      "Axes against the URDF's, in base_link with all joints at zero: value ± U (95\u00a0%), across the axis",
      {"Axis", "u along", "v along", "Moved along u (mm)", "Moved along v (mm)", "Tilted towards u (mdeg)",
       "Tilted towards v (mdeg)"},
      {{}},
      false,
      "calibrated-axes"};
  reports::DataTable& data = table.data.emplace();
  data.columns = {"axis",
                  "u_x",
                  "u_y",
                  "u_z",
                  "v_x",
                  "v_y",
                  "v_z",
                  "moved_u_mm",
                  "sd_moved_u_mm",
                  "moved_v_mm",
                  "sd_moved_v_mm",
                  "tilted_u_mdeg",
                  "sd_tilted_u_mdeg",
                  "tilted_v_mdeg",
                  "sd_tilted_v_mdeg"};
  for (int j = 0; j < static_cast<int>(fit.start.size()); ++j) {
    const metrology::MeasuredLine& start = fit.start[static_cast<std::size_t>(j)];
    reports::Row row{fmt::format("{}", j + 1), directionWords(start.across_u), directionWords(start.across_v)};
    std::vector<reports::DataCell> cells{j + 1.0};
    for (const Eigen::Vector3d& across : {start.across_u, start.across_v})
      for (const double part : across) cells.emplace_back(part);
    for (int k = 0; k < 4; ++k) {
      const int at = 4 * j + k;
      const double unit = k < 2 ? io::kMillimetre : kMillidegree, sd = fit.sd(at);
      row.emplace_back(sd > 0.0 ? reports::withUncertainty(fit.steps[at] / unit, reports::expanded(sd) / unit) : "–");
      cells.push_back(sd > 0.0 ? reports::DataCell(fit.steps[at] / unit) : reports::DataCell());
      cells.push_back(sd > 0.0 ? reports::DataCell(sd / unit) : reports::DataCell());
    }
    table.groups.front().rows.push_back(std::move(row));
    data.rows.push_back(std::move(cells));
  }
  return table;
}

reports::Table linksTable(const calibration::Calibration& calibration) {
  const robot::Robot& nominal = calibration.day.arm;
  const calibration::DenavitHartenberg now =
      calibration::denavitHartenberg(calibration.geometry().fit.arm(nominal), nominal);
  const calibration::DenavitHartenberg built = calibration::denavitHartenberg(nominal, nominal);
  const PerJoint<calibration::LinkParameters> sds = calibration::linkUncertainties(calibration.geometry().fit, nominal);
  reports::Table table{
      "Denavit and Hartenberg's parameters, calibrated ± U (95\u00a0%), and the URDF's in small type; "
      "without a ± they are fixed, held or by choice of frame",
      {"Axes", "θ (°)", "d (mm), or β (°)", "a (mm)", "α (°)"},
      {{}},
      false,
      "denavit-hartenberg"};
  reports::DataTable& data = table.data.emplace();
  data.columns = {"axis_from",    "axis_to",        "theta_deg", "d_mm",         "a_mm",           "alpha_deg",
                  "beta_deg",     "urdf_theta_deg", "urdf_d_mm", "urdf_a_mm",    "urdf_alpha_deg", "urdf_beta_deg",
                  "sd_theta_deg", "sd_d_mm",        "sd_a_mm",   "sd_alpha_deg", "sd_beta_deg"};
  // Of nearly parallel axes there is no d but Hayati's beta.
  const auto addCells = [](const calibration::LinkParameters& link, bool hayati, std::vector<reports::DataCell>& row) {
    row.emplace_back(link.theta / io::kDegree);
    row.push_back(hayati ? reports::DataCell() : reports::DataCell(link.d / io::kMillimetre));
    row.emplace_back(link.a / io::kMillimetre);
    row.emplace_back(link.alpha / io::kDegree);
    row.push_back(hayati ? reports::DataCell(link.beta / io::kDegree) : reports::DataCell());
  };
  // What is fixed has no uncertainty.
  const auto addUncertainties = [](const calibration::LinkParameters& sd, std::vector<reports::DataCell>& row) {
    const auto cell = [](double own, double unit) {
      return own > 0.0 ? reports::DataCell(own / unit) : reports::DataCell();
    };
    row.push_back(cell(sd.theta, io::kDegree));
    row.push_back(cell(sd.d, io::kMillimetre));
    row.push_back(cell(sd.a, io::kMillimetre));
    row.push_back(cell(sd.alpha, io::kDegree));
    row.push_back(cell(sd.beta, io::kDegree));
  };
  // A parameter that nothing fitted moves is the URDF's own.
  const auto both = [](double value, double sd, double urdf) {
    constexpr int kOfUrdf = 3;
    return reports::Cell(sd > 0.0 ? reports::withUncertainty(value, reports::expanded(sd))
                                  : reports::fixed(reports::unsignedZero(value, kOfUrdf), kOfUrdf),
                         reports::fixed(reports::unsignedZero(urdf, kOfUrdf), kOfUrdf));
  };
  for (std::size_t i = 0; i < now.links.size(); ++i) {
    const calibration::LinkParameters &link = now.links[i], &as_built = built.links[i], &sd = sds[i];
    std::vector<reports::DataCell>& cells = data.rows.emplace_back();
    cells = {static_cast<double>(i + 1), static_cast<double>(i + 2)};
    addCells(link, link.hayati, cells);
    addCells(as_built, link.hayati, cells);
    addUncertainties(sd, cells);
    table.groups.front().rows.push_back(
        {reports::Cell(fmt::format("{} and {}", i + 1, i + 2), link.hayati ? "β: Hayati" : ""),
         both(link.theta / io::kDegree, sd.theta / io::kDegree, as_built.theta / io::kDegree),
         link.hayati ? both(link.beta / io::kDegree, sd.beta / io::kDegree, as_built.beta / io::kDegree)
                     : both(link.d / io::kMillimetre, sd.d / io::kMillimetre, as_built.d / io::kMillimetre),
         both(link.a / io::kMillimetre, sd.a / io::kMillimetre, as_built.a / io::kMillimetre),
         both(link.alpha / io::kDegree, sd.alpha / io::kDegree, as_built.alpha / io::kDegree)});
  }
  return table;
}

reports::Row pointRow(const std::string& name, const calibration::UncertainPoint& point, double unit) {
  reports::Row row{name};
  for (int k = 0; k < 3; ++k) {
    const double sd = point.sd[k];
    row.emplace_back(sd > 0.0 ? reports::withUncertainty(point.value[k] / unit, reports::expanded(sd) / unit)
                              : reports::fixed(point.value[k] / unit, 3));
  }
  return row;
}

/// The tracker against the base, and the reflectors on the flange.
reports::Table placesTable(const calibration::Calibration& calibration) {
  const calibration::ArmFit& fit = calibration.geometry().fit;
  reports::Table table{"Base and reflectors by the calibrated geometry: value ± U (95\u00a0%)",
                       {"What", "x", "y", "z"},
                       {{}},
                       false,
                       "places"};
  reports::DataTable& data = table.data.emplace();
  data.columns = {"what",       "name",          "x_mm",          "y_mm",         "z_mm",
                  "sd_x_mm",    "sd_y_mm",       "sd_z_mm",       "turn_x_deg",   "turn_y_deg",
                  "turn_z_deg", "sd_turn_x_deg", "sd_turn_y_deg", "sd_turn_z_deg"};
  const auto addData = [&data](const std::string& what, const std::string& name,
                               const calibration::UncertainPoint& place, const calibration::UncertainPoint* turn) {
    std::vector<reports::DataCell> row{what, name};
    const auto add = [&row](const calibration::UncertainPoint* point, double unit) {
      for (int k = 0; k < 3; ++k)
        row.push_back(point ? reports::DataCell(point->value[k] / unit) : reports::DataCell());
      for (int k = 0; k < 3; ++k)
        row.push_back(point && point->sd[k] > 0.0 ? reports::DataCell(point->sd[k] / unit) : reports::DataCell());
    };
    add(&place, io::kMillimetre);
    add(turn, io::kDegree);
    data.rows.push_back(std::move(row));
  };
  const calibration::UncertainPoint turn = calibration::turnOfStation(fit);
  addData("tracker_in_base_link", "", calibration::stationInBase(calibration.day, fit), &turn);
  reports::RowGroup& group = table.groups.front();
  group.rows.push_back(
      pointRow("Tracker in base_link (mm)", calibration::stationInBase(calibration.day, fit), io::kMillimetre));
  group.rows.push_back(pointRow("Turn of its axes, rotation vector (°)", turn, io::kDegree));
  const std::vector<calibration::UncertainPoint> targets = calibration::targetsInFlange(calibration.day, fit);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    group.rows.push_back(pointRow(fmt::format("{} in the flange (mm)", reports::pointName(calibration.day.targets[t])),
                                  targets[t], io::kMillimetre));
    addData("reflector_in_flange", calibration.day.targets[t], targets[t], nullptr);
  }
  return table;
}

/// By the own weight's torques; none where the URDF states no masses.
reports::Table stiffnessTable(const calibration::Calibration& calibration) {
  const std::vector<reports::JointStiffness> joints = reports::stiffnessOf(calibration.best().fit);
  std::vector<double> stiffnesses;
  for (const reports::JointStiffness& joint : joints)
    if (joint.value > 0.0) stiffnesses.push_back(joint.value);
  const reports::StiffnessUnit unit = reports::stiffnessUnit(stiffnesses);
  reports::Table table{fmt::format("Joint stiffness by the arm's own weight, k ± U (95\u00a0%), {}", unit.name),
                       {"Joint", "k"},
                       {{}},
                       false,
                       "own-weight-stiffness"};
  reports::DataTable& data = table.data.emplace();
  data.columns = {"joint", "stiffness_nm_per_rad", "sd_nm_per_rad"};
  if (!calibration.day.masses_known) return table;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].value > 0.0) {
      data.rows.push_back({static_cast<double>(j + 1), joints[j].value, joints[j].sd});
      table.groups.front().rows.push_back(
          {reports::jointName(static_cast<int>(j)),
           reports::withUncertainty(joints[j].value / unit.size, reports::expanded(joints[j].sd) / unit.size)});
    }
  }
  return table;
}

}  // namespace

void writeParameters(Html& html, const reports::ReportContent& content) {
  const auto write = [&](const reports::ReportCampaign& one) {
    const calibration::Calibration& calibration = one.accuracy->calibration;
    writeTable(html, axesTable(calibration));
    if (const std::string caution = reports::geometryCaution(calibration); !caution.empty())
      html.paragraph("Caution: " + caution + ".");
    if (const std::string growth = reports::growthFromWords(calibration::growthFrom(one.campaign, calibration));
        !growth.empty())
      html.paragraph(growth + ".");
    const std::vector<std::string> unknown = reports::notIdentifiableWords(calibration);
    if (!unknown.empty()) html.paragraph("Not identifiable, or hardly:");
    html.list(unknown);
    writeTable(html, linksTable(calibration));
    writeTable(html, placesTable(calibration));
    const reports::Table stiffness = stiffnessTable(calibration);
    writeTable(html, stiffness);
    if (const std::string doubt = reports::stiffnessDoubt(*one.accuracy);
        !doubt.empty() && !stiffness.groups.front().rows.empty())
      html.paragraph(doubt);
  };
  writeForEach(html, content, "parameters", "Parameters of the calibrated geometry", isCalibrated, write);
}

}  // namespace stiffscope::page
