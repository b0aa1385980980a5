#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/input/units.h"
#include "reports/page/html_table.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"
#include "reports/page/paper_values.h"
#include "reports/page/sections.h"

namespace stiffscope::page {

namespace {

void addPoint(Row& row, const Eigen::Vector3d& point) {
  for (int k = 0; k < 3; ++k) row.emplace_back(fixed(point[k] / kMillimetre, 3));
}

Table tableOne(const ReportCampaign& one, const WristCentre& wrist) {
  Table table{
      "Table I: centre of the sphere of each reflector's own sweep, in R_{0}",
      {"Reflector", "X (mm)", "Y (mm)", "Z (mm)", "Offset (mm)", "Radius (mm)", "rms (µm)", "Count"},
      {{}}};
  table.id = "wrist-spheres";
  for (const WristTableRow& line : wrist.table) {
    Row row{pointName(one.campaign.targets[static_cast<std::size_t>(line.target)].id)};
    addPoint(row, line.centre_in_r0);
    row.emplace_back(fixed(line.offset / kMillimetre, 3));
    row.emplace_back(fixed(line.radius / kMillimetre, 3));
    row.emplace_back(fixed(line.rms / kMicrometre, 1));
    row.emplace_back(std::to_string(line.readings));
    table.groups.front().rows.push_back(std::move(row));
  }
  Row mean_row{"Mean of them"};
  for (int k = 0; k < 3; ++k) {
    mean_row.emplace_back(withUncertainty(wrist.table_mean_in_r0[k] / kMillimetre,
                                          std::sqrt(wrist.table_mean_covariance(k, k)) / kMillimetre));
  }
  for (int k = 0; k < 4; ++k) mean_row.emplace_back("–");
  table.groups.push_back({"", {std::move(mean_row)}});
  return table;
}

Table sideBySide(const WristCentre& wrist) {
  Table table{"Three ways to a wrist centre, in R_{0}",
              {"Point", "X (mm)", "Y (mm)", "Z (mm)", "From the sphere centre (mm)"},
              {{}}};
  table.id = "wrist-centres";
  const auto add = [&](const char* name, const Eigen::Vector3d& point) {
    Row row{name};
    addPoint(row, point);
    row.emplace_back(fixed((point - wrist.centre_in_r0).norm() / kMillimetre, 3));
    table.groups.front().rows.push_back(std::move(row));
  };
  Row sphere{"P_{wrist}: common centre of all spheres"};
  for (int k = 0; k < 3; ++k) {
    sphere.emplace_back(withUncertainty(wrist.centre_in_r0[k] / kMillimetre,
                                        std::sqrt(wrist.covariance(k, k)) / kMillimetre));
  }
  sphere.emplace_back("–");
  table.groups.front().rows.push_back(std::move(sphere));
  add("Nearest axes 5 and 6", wrist.nearest_axes_56_in_r0);
  add("Barycentre of the reflectors (Dumas et al.)", wrist.reflector_barycentre_in_r0);
  return table;
}

std::string missWords(double miss, double sd) {
  if (sd <= 0.0)
    return fmt::format("{} mm (by the robot's description: not measured)",
                       significant(miss / kMillimetre, 3));
  return fmt::format("{} mm", withUncertainty(miss / kMillimetre, sd / kMillimetre));
}

void writeMeasured(Html& html, const ReportContent& content, const ReportCampaign& one,
                   const WristCentre& wrist) {
  double largest = 0.0;
  for (const WristTableRow& line : wrist.table) largest = std::max(largest, line.offset / kMillimetre);
  std::string words = fmt::format("The reflectors' centres agree to {} mm.", fixed(largest, 3));
  if (content.compare_with_paper) {
    words += fmt::format(" The paper's Table I: {} mm.", fixed(kPaperWristOffsetMm, 2));
  }
  html.paragraph(words);
  writeTable(html, tableOne(one, wrist));
  writeTable(html, sideBySide(wrist));
  html.paragraph(
      fmt::format("Axes 4 and 5 miss each other by {}, axes 5 and 6 by {}; ± is one standard uncertainty (k = 1).",
                  missWords(wrist.miss_45, wrist.miss_45_sd), missWords(wrist.miss_56, wrist.miss_56_sd)));
}

}  // namespace

void writeWrist(Html& html, const ReportContent& content) {
  writeForEach(html, content, "wrist", "Wrist centre", [&](const ReportCampaign& one) {
    const WristCentre& wrist = one.identification.frames.wrist;
    if (wrist.measured) {
      writeMeasured(html, content, one, wrist);
    } else {
      html.paragraph(fmt::format("P_{{wrist}} is not measured: {}.", wrist.reason));
    }
  });
}

}  // namespace stiffscope::page
