#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/io/units.h"
#include "reports/csv/csv_table.h"
#include "reports/page/diagnosis_tables.h"
#include "reports/page/facts.h"
#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/day_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/paper_values.h"
#include "reports/words/preparation_words.h"
#include "reports/words/remark_words.h"

namespace stiffscope::page {

namespace {

void add(reports::RowGroup& group, const char* name, const std::string& text) {
  if (!text.empty()) group.rows.push_back({name, text});
}

/// A text of the campaign; empty stays empty, so that its row is left out.
std::string own(const std::string& text) { return text.empty() ? text : reports::asIs(text); }

std::string trackerWords(const campaign::Tracker& tracker) {
  return fmt::format("{}; one sigma {} µm + {} µm/m along the beam, {} µm + {} µm/m across it",
                     reports::asIs(tracker.model), reports::significant(tracker.range_fixed / io::kMicrometre, 2),
                     reports::significant(tracker.range_per_m / io::kMicrometre, 2),
                     reports::significant(tracker.angle_fixed / io::kMicrometre, 2),
                     reports::significant(tracker.angle_per_m / io::kMicrometre, 2));
}

std::string loadWords(const identification::Identification& result) {
  const std::string force =
      fmt::format("load step {}, mean force {} N", result.step, reports::fixed(reports::meanForce(result), 0));
  const double angle_deg = result.identifiability.gravity_angle_rms / io::kDegree;
  return fmt::format("{}; {} (within {}° of gravity, rms)", force,
                     result.identifiability.load_hangs ? "it hangs" : "it pulls aslant",
                     reports::significant(angle_deg, 2));
}

std::string deflectionWords(const identification::Identification& result) {
  if (!result.finite_deflection) return "small deflections: K_{c} neglected, Jacobians at the unloaded posture";
  return fmt::format(
      "finite: K_{{c}} of the paper's (4) included (it changes the joint torques by {}), Jacobians at the middle of "
      "the displacement",
      reports::percent(result.geometric_stiffness_share, 2));
}

std::string calibrationWords(const frames::GeometryCalibration& calibration) {
  if (!calibration.done) return fmt::format("not calibrated: {}", reports::words(calibration.reason));
  return fmt::format("{} parameters from {} unloaded positions; rms {} mm before, {} mm after, per coordinate",
                     calibration.parameters, calibration.positions,
                     reports::significant(calibration.rms_before / io::kMillimetre, 3),
                     reports::significant(calibration.rms_after / io::kMillimetre, 3));
}

void addUnloaded(reports::RowGroup& group, const calibration::Calibration& calibration) {
  const calibration::UnloadedDay& day = calibration.day;
  add(group, "Postures",
      fmt::format("{} unloaded, {} readings of {} reflector{}; {} left out", day.postures.size(), day.readings(),
                  day.targets.size(), day.targets.size() == 1 ? "" : "s", calibration.rejected.size()));
  add(group, "Own weight", day.masses_known ? "the URDF states the masses" : "the URDF states no link masses");
}

reports::RowGroup conditions(const reports::ReportCampaign& one) {
  const campaign::Campaign& campaign = one.campaign;
  const identification::Identification& result = one.identification;
  const std::optional<campaign::Tracker>& tracker =
      one.preparation != nullptr ? one.preparation->declared : campaign.tracker;
  reports::RowGroup group;
  add(group, "Machine", own(campaign.robot.name));
  add(group, "Measured on", own(campaign.date));
  add(group, "Double encoders", reports::encoderWordsOf(campaign));
  add(group, "Item", own(campaign.texts.item));
  add(group, "Laboratory", own(campaign.texts.laboratory));
  add(group, "Customer", own(campaign.texts.customer));
  add(group, "Operator", own(campaign.texts.operator_name));
  add(group, "Conditions", own(campaign.texts.conditions));
  add(group, "Tracker", tracker ? trackerWords(*tracker) : "not declared: no noise is known");
  if (one.preparation != nullptr)
    add(group, "Readings", reports::withMicro(reports::preparationWords(*one.preparation)));
  if (one.accuracy != nullptr) addUnloaded(group, one.accuracy->calibration);
  if (!isLoaded(one)) return group;
  add(group, "Postures", fmt::format("{} used, {} left out", result.cases.size(), result.left_out.size()));
  add(group, "Load", result.cases.empty() ? "none was measured that could be used" : loadWords(result));
  add(group, "Own weight", reports::words(result.frames.sag_note));
  if (!result.cases.empty()) add(group, "Deflection", deflectionWords(result));
  if (!result.cases.empty())
    add(group, "Servo",
        result.servo_change == 0.0
            ? std::string("reported joint angles do not change under load")
            : fmt::format("reported joint angles change by at most {}° under load; not subtracted",
                          reports::significant(result.servo_change / io::kDegree, 2)));
  if (result.of(identification::Method::complete_pose).available) {
    add(group, "Characteristic length",
        fmt::format("{} m, condition number {} there", reports::significant(result.characteristic_length.length, 3),
                    reports::significant(result.characteristic_length.condition, 3)));
  }
  add(group, "PP's geometry", calibrationWords(result.calibration));
  return group;
}

/// Whether its sections have tables or equations by the paper's numbers.
bool namesThePaper(const reports::ReportCampaign& one) {
  return isLoaded(one) || one.identification.frames.wrist.measured;
}

/// What the audit finds of the same readings, where that is another number; empty where it is not, or where the model
/// takes nothing off them.
std::string auditFinds(const reports::ReportCampaign& one, std::string_view id, double here, const char* what) {
  if (one.audit == nullptr || one.improved == nullptr || one.improved->effects.added.empty()) return {};
  const auto& checks = one.audit->checks;
  const auto check = std::find_if(checks.begin(), checks.end(), [id](const auto& own) { return own.id == id; });
  constexpr int kDigits = 2;
  const auto shown = [](double metres) { return reports::significant(metres / io::kMillimetre, kDigits); };
  if (check == checks.end() || !check->value || shown(*check->value) == shown(here)) return {};
  return fmt::format(
      "The audit looks at the readings before the effects of the model are taken off them: by it {} up to {}\u00a0mm, "
      "instead of {}\u00a0mm here.",
      what, shown(*check->value), shown(here));
}

}  // namespace

void writeConditions(Html& html, const reports::ReportContent& content) {
  const auto section = html.element("section", {{"id", "conditions"}});
  html.leaf("h2", "Method and conditions");
  using reports::DayKind;
  for (const DayKind kind : {DayKind::unloaded, DayKind::loaded, DayKind::sweeps}) {
    std::vector<std::string> said;  // of machines of several numbers of joints one a number
    for (const reports::ReportCampaign& one : reports::ofKind(content.campaigns, kind)) {
      const std::string words = reports::methodWords(kind, one.campaign.robot.joints());
      if (std::find(said.begin(), said.end(), words) != said.end()) continue;
      html.paragraph(words);
      said.push_back(words);
    }
  }
  if (std::any_of(content.campaigns.begin(), content.campaigns.end(), namesThePaper)) {
    html.paragraph(
        "The paper is Ambiehl, Garnier, Subrin and Furet, IROS 2017: Table I, Table II and (4) are named as in it.",
        "faint");
  }
  std::vector<Facts> facts;
  for (std::size_t i = 0; i < content.campaigns.size(); ++i) {
    const reports::RowGroup rows = conditions(content.campaigns[i]);
    if (content.campaigns.size() > 1) html.setTableSuffix(fmt::format("-{}", i + 1));
    html.keepTable("conditions", reports::csvTable(reports::Table{"", {"What", "As measured"}, {rows}, true}));
    // What the first page says is not said again.
    const Facts said = whoAndWhat(content.campaigns[i]);
    facts.emplace_back();
    for (const reports::Row& row : rows.rows) {
      const bool again = std::any_of(said.begin(), said.end(), [&row](const auto& one) {
        return one.first == row[0].text && one.second == row[1].text;
      });
      if (!again) facts.back().emplace_back(row[0].text, row[1].text);
    }
  }
  html.setTableSuffix("");
  writeFacts(html, "Conditions of the measurement", columnNames(content), sideBySide(facts));
  writeFiguresOf(html, content, "conditions");
}

namespace {

reports::Table linkTable(const frames::Frames& frames, Notes& notes) {
  reports::Table table{
      "Distance and angle between consecutive axes",
      {"Axes", "Distance (mm)", "Nominal (mm)", "Difference (mm)", "Angle (°)", "Nominal (°)", "Difference (°)"},
      {{}}};
  table.id = "links";
  reports::DataTable& data = table.data.emplace();
  data.columns = {"Axes",      "Distance (mm)",  "± of Distance (mm)", "Nominal (mm)",   "Difference (mm)",
                  "Angle (°)", "± of Angle (°)", "Nominal (°)",        "Difference (°)", "near_parallel"};
  for (std::size_t i = 0; i < frames.links.size(); ++i) {
    const frames::LinkGeometry& link = frames.links[i];
    reports::Row row{reports::Cell(
        fmt::format("{} and {}", i + 1, i + 2),
        link.near_parallel ? notes.mark("These axes are within a degree of parallel: the distance is that across the "
                                        "first axis, at the foot on it of the common perpendicular with the axis "
                                        "before (Hayati).")
                           : "")};
    std::vector<reports::DataCell> cells{fmt::format("{} and {}", i + 1, i + 2)};
    const auto add = [&](double value, const std::optional<double>& sd, double nominal, double unit) {
      const auto cell = [&](double number) { return sd ? reports::DataCell(number / unit) : reports::DataCell(); };
      cells.push_back(cell(value));
      cells.push_back(cell(sd ? reports::expanded(*sd) : 0.0));
      cells.emplace_back(nominal / unit);
      cells.push_back(cell(value - nominal));
      row.emplace_back(sd ? reports::withUncertainty(value / unit, reports::expanded(*sd) / unit) : "not measured");
      row.emplace_back(reports::fixed(nominal / unit, 3));
      row.emplace_back(sd ? reports::fixed((value - nominal) / unit, 3) : "–");
    };
    add(link.distance, link.distance_sd, link.nominal_distance, io::kMillimetre);
    add(link.angle, link.angle_sd, link.nominal_angle, io::kDegree);
    table.groups.front().rows.push_back(std::move(row));
    cells.emplace_back(link.near_parallel ? 1.0 : 0.0);
    data.rows.push_back(std::move(cells));
  }
  return table;
}

reports::Table axisTable(const frames::Frames& frames) {
  double largest = 0.0;
  for (const frames::MeasuredAxis& axis : frames.axes) largest = std::max(largest, axis.measured ? axis.fit.rms : 0.0);
  const reports::LengthUnit unit = reports::lengthUnit(largest);
  reports::Table table{"Circle-point: the sweeps of each axis",
                       {"Axis", "Arc (°)", "Circles", fmt::format("rms ({})", unit.name)},
                       {{}}};
  table.id = "axes";
  // In the file besides: where the axes run, in R0 with all joints at zero.
  reports::DataTable& data = table.data.emplace();
  data.columns = {"Axis", "Arc (°)", "Circles", "rms (µm)"};
  for (const char* column : {"point_x_mm", "point_y_mm", "point_z_mm", "direction_x", "direction_y", "direction_z",
                             "sd_point_um", "sd_direction_deg"})
    data.columns.emplace_back(column);
  for (std::size_t i = 0; i < frames.axes.size(); ++i) {
    const frames::MeasuredAxis& axis = frames.axes[i];
    if (!axis.measured) continue;
    double arc = 0.0;
    for (const metrology::AxisCircle& circle : axis.fit.circles) arc = std::max(arc, circle.arc);
    // Axes of coupled joints come from all sweeps together: none has circles of its own, and an arc of 0 is none.
    const bool alone = !axis.fit.circles.empty();
    const auto own = [alone](double number) { return alone ? reports::fixed(number, 0) : std::string("–"); };
    const auto circles = static_cast<double>(axis.fit.circles.size());
    table.groups.front().rows.push_back(
        {std::to_string(i + 1), own(arc / io::kDegree), own(circles), lengthIn(axis.fit.rms, unit)});
    data.rows.push_back({static_cast<double>(i + 1), arc / io::kDegree, circles, axis.fit.rms / io::kMicrometre});
    const metrology::Line& line = frames.arm.arm.axes_in_base_at_zero[i];
    std::vector<reports::DataCell>& row = data.rows.back();
    // What R0's own definition makes zero is zero, and not a processor's rounding.
    const auto settled = [](double number) { return std::abs(number) < 1e-9 ? 0.0 : number; };
    for (const double part : line.point) row.emplace_back(settled(part / io::kMillimetre));
    for (const double part : line.direction) row.emplace_back(settled(part));
    const reports::AxisSd sd = reports::sdAcross(axis);
    row.emplace_back(sd.point / io::kMicrometre);
    row.emplace_back(sd.direction / io::kDegree);
  }
  return table;
}

}  // namespace

void writeLinks(Html& html, const reports::ReportContent& content) {
  writeForEach(html, content, "links", "Link lengths and angles", hasAxes, [&](const reports::ReportCampaign& one) {
    const frames::Frames& frames = one.identification.frames;
    std::vector<std::string> unmeasured;
    for (std::size_t i = 0; i < frames.axes.size(); ++i) {
      if (!frames.axes[i].measured)
        unmeasured.push_back(fmt::format("Axis {}: {}.", i + 1, reports::words(frames.axes[i].reason)));
    }
    if (unmeasured.size() == frames.axes.size()) {
      html.paragraph(fmt::format("No axis was measured ({}); the geometry is that of the robot's description.",
                                 reports::words(frames.axes.front().reason)));
      return;
    }
    Notes notes;
    writeTable(html, linkTable(frames, notes));
    writeTable(html, axisTable(frames));
    html.paragraph("± is the expanded uncertainty U, coverage about 95\u00a0%.", "faint");
    notes.write(html);
    if (const std::string other = auditFinds(one, "link_lengths", reports::largestLinkDifference(frames),
                                             "distances are off the nominal ones by");
        !other.empty())
      html.paragraph(other, "faint");
    html.list(unmeasured);
  });
}

namespace {

void addPoint(reports::Row& row, const Eigen::Vector3d& point) {
  for (int k = 0; k < 3; ++k) row.emplace_back(reports::fixed(point[k] / io::kMillimetre, 3));
}

/// The file of table I where people read its rms in mm: the same columns as where they read it in µm.
reports::DataTable wristSpheres(const reports::ReportCampaign& one, const frames::WristCentre& wrist) {
  reports::DataTable data;
  data.columns = {"Reflector"};
  for (const char* axis : {"X (mm)", "Y (mm)", "Z (mm)"}) {
    data.columns.emplace_back(axis);
    data.columns.push_back(fmt::format("± of {}", axis));
  }
  for (const char* column : {"Offset (mm)", "Radius (mm)", "rms (µm)", "Count"}) data.columns.emplace_back(column);
  for (const frames::WristTableRow& line : wrist.table) {
    std::vector<reports::DataCell> row{one.campaign.targets[static_cast<std::size_t>(line.target)].id};
    for (int k = 0; k < 3; ++k) {
      row.emplace_back(line.centre_in_r0[k] / io::kMillimetre);
      row.emplace_back();
    }
    row.emplace_back(line.offset / io::kMillimetre);
    row.emplace_back(line.radius / io::kMillimetre);
    row.emplace_back(line.rms / io::kMicrometre);
    row.emplace_back(static_cast<double>(line.readings));
    data.rows.push_back(std::move(row));
  }
  std::vector<reports::DataCell> mean{std::string("Mean of them")};
  for (int k = 0; k < 3; ++k) {
    mean.emplace_back(wrist.table_mean_in_r0[k] / io::kMillimetre);
    mean.emplace_back(reports::expanded(std::sqrt(wrist.table_mean_covariance(k, k))) / io::kMillimetre);
  }
  mean.resize(data.columns.size());
  data.rows.push_back(std::move(mean));
  return data;
}

reports::Table tableOne(const reports::ReportCampaign& one, const frames::WristCentre& wrist) {
  double largest = 0.0;
  for (const frames::WristTableRow& line : wrist.table) largest = std::max(largest, line.rms);
  const reports::LengthUnit unit = reports::lengthUnit(largest);
  reports::Table table{"Table I: centre of the sphere of each reflector's own sweep, in R_{0}",
                       {"Reflector", "X (mm)", "Y (mm)", "Z (mm)", "Offset (mm)", "Radius (mm)",
                        fmt::format("rms ({})", unit.name), "Count"},
                       {{}}};
  table.id = "wrist-spheres";
  for (const frames::WristTableRow& line : wrist.table) {
    reports::Row row{reports::pointName(one.campaign.targets[static_cast<std::size_t>(line.target)].id)};
    addPoint(row, line.centre_in_r0);
    row.emplace_back(reports::fixed(line.offset / io::kMillimetre, 3));
    row.emplace_back(reports::fixed(line.radius / io::kMillimetre, 3));
    row.emplace_back(lengthIn(line.rms, unit));
    row.emplace_back(std::to_string(line.readings));
    table.groups.front().rows.push_back(std::move(row));
  }
  reports::Row mean_row{"Mean of them"};
  for (int k = 0; k < 3; ++k) {
    mean_row.emplace_back(
        reports::withUncertainty(wrist.table_mean_in_r0[k] / io::kMillimetre,
                                 reports::expanded(std::sqrt(wrist.table_mean_covariance(k, k))) / io::kMillimetre));
  }
  for (int k = 0; k < 4; ++k) mean_row.emplace_back("–");
  table.groups.push_back({"", {std::move(mean_row)}});
  if (unit.size == io::kMillimetre) table.data = wristSpheres(one, wrist);
  return table;
}

reports::Table sideBySide(const frames::WristCentre& wrist) {
  reports::Table table{"Three ways to a wrist centre, in R_{0}",
                       {"Point", "X (mm)", "Y (mm)", "Z (mm)", "From the sphere centre (mm)"},
                       {{}}};
  table.id = "wrist-centres";
  const auto add = [&](const std::string& name, const Eigen::Vector3d& point) {
    reports::Row row{name};
    addPoint(row, point);
    row.emplace_back(reports::fixed((point - wrist.centre_in_r0).norm() / io::kMillimetre, 3));
    table.groups.front().rows.push_back(std::move(row));
  };
  reports::Row sphere{"P_{wrist}: common centre of all spheres"};
  for (int k = 0; k < 3; ++k) {
    sphere.emplace_back(
        reports::withUncertainty(wrist.centre_in_r0[k] / io::kMillimetre,
                                 reports::expanded(std::sqrt(wrist.covariance(k, k))) / io::kMillimetre));
  }
  sphere.emplace_back("–");
  table.groups.front().rows.push_back(std::move(sphere));
  const int last = static_cast<int>(wrist.q.size());
  add(fmt::format("Nearest axes {} and {}", last - 1, last), wrist.nearest_last_axes_in_r0);
  add("Barycentre of the reflectors (Dumas et al.)", wrist.reflector_barycentre_in_r0);
  return table;
}

std::string missWords(double miss, double sd) {
  if (sd <= 0.0)
    return fmt::format("{} mm (by the robot's description: not measured)",
                       reports::significant(miss / io::kMillimetre, 3));
  return fmt::format("{} mm",
                     reports::withUncertainty(miss / io::kMillimetre, reports::expanded(sd) / io::kMillimetre));
}

void writeMeasured(Html& html, const reports::ReportContent& content, const reports::ReportCampaign& one,
                   const frames::WristCentre& wrist) {
  double largest = 0.0;
  for (const frames::WristTableRow& line : wrist.table) largest = std::max(largest, line.offset / io::kMillimetre);
  std::string words = fmt::format("The reflectors' centres agree to {} mm.", reports::fixed(largest, 3));
  if (content.compare_with_paper) {
    words += fmt::format(" The paper's Table I: {} mm.", reports::fixed(reports::kPaperWristOffsetMm, 2));
  }
  html.paragraph(words);
  writeTable(html, tableOne(one, wrist));
  writeTable(html, sideBySide(wrist));
  std::string misses;
  for (const frames::WristAxesMiss& miss : wrist.misses) {
    misses += fmt::format("{} {} and {}{} by {}", misses.empty() ? "Axes" : ", axes", miss.first + 1, miss.first + 2,
                          misses.empty() ? " miss each other" : "", missWords(miss.distance, miss.sd));
  }
  html.paragraph(misses + "; ± is U, about 95\u00a0%.");
  if (wrist.offset())
    html.paragraph(reports::capitalised(reports::offsetWristWords(wrist.misses[0].first + 1, wrist.apart)) + ".");
  double miss = 0.0;
  for (const frames::WristAxesMiss& own : wrist.misses) miss = std::max(miss, own.distance);
  if (const std::string other = auditFinds(one, "wrist_axes_meet", miss, "the wrist's axes miss each other by");
      !other.empty())
    html.paragraph(other, "faint");
}

}  // namespace

void writeWrist(Html& html, const reports::ReportContent& content) {
  writeForEach(html, content, "wrist", "Wrist centre", hasWrist, [&](const reports::ReportCampaign& one) {
    const frames::WristCentre& wrist = one.identification.frames.wrist;
    if (wrist.measured) {
      writeMeasured(html, content, one, wrist);
    } else {
      html.paragraph(fmt::format("P_{{wrist}} is not measured: {}.", reports::words(wrist.reason)));
    }
  });
}

}  // namespace stiffscope::page
