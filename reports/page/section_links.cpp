#include <fmt/format.h>

#include <algorithm>

#include "core/input/units.h"
#include "reports/page/html_table.h"
#include "reports/page/numbers.h"
#include "reports/page/sections.h"

namespace stiffscope::page {

namespace {

Table linkTable(const Frames& frames, Notes& notes) {
  Table table{"Distance and angle between consecutive axes",
              {"Axes", "Distance (mm)", "Nominal (mm)", "Difference (mm)", "Angle (°)", "Nominal (°)",
               "Difference (°)"},
              {{}}};
  table.id = "links";
  for (std::size_t i = 0; i < frames.links.size(); ++i) {
    const LinkGeometry& link = frames.links[i];
    Row row{
        Cell(fmt::format("{} and {}", i + 1, i + 2),
             link.near_parallel
                 ? notes.mark("These axes are within a degree of parallel: the distance is that across the "
                              "first axis, at the foot on it of the common perpendicular with the axis "
                              "before (Hayati).")
                 : "")};
    const auto add = [&](double value, const std::optional<double>& sd, double nominal, double unit) {
      row.emplace_back(sd ? withUncertainty(value / unit, *sd / unit) : "not measured");
      row.emplace_back(fixed(nominal / unit, 3));
      row.emplace_back(sd ? fixed((value - nominal) / unit, 3) : "–");
    };
    add(link.distance, link.distance_sd, link.nominal_distance, kMillimetre);
    add(link.angle, link.angle_sd, link.nominal_angle, kDegree);
    table.groups.front().rows.push_back(std::move(row));
  }
  return table;
}

Table axisTable(const Frames& frames) {
  Table table{"Circle-point: the sweeps of each axis", {"Axis", "Arc (°)", "Circles", "rms (µm)"}, {{}}};
  table.id = "axes";
  for (std::size_t i = 0; i < frames.axes.size(); ++i) {
    const MeasuredAxis& axis = frames.axes[i];
    if (!axis.measured) continue;
    double arc = 0.0;
    for (const AxisCircle& circle : axis.fit.circles) arc = std::max(arc, circle.arc);
    table.groups.front().rows.push_back({std::to_string(i + 1), fixed(arc / kDegree, 0),
                                         std::to_string(axis.fit.circles.size()),
                                         fixed(axis.fit.rms / kMicrometre, 1)});
  }
  return table;
}

}  // namespace

void writeLinks(Html& html, const ReportContent& content) {
  writeForEach(html, content, "links", "Link lengths and angles", [&](const ReportCampaign& one) {
    const Frames& frames = one.identification.frames;
    std::vector<std::string> unmeasured;
    for (std::size_t i = 0; i < frames.axes.size(); ++i) {
      if (!frames.axes[i].measured)
        unmeasured.push_back(fmt::format("Axis {}: {}.", i + 1, frames.axes[i].reason));
    }
    if (unmeasured.size() == frames.axes.size()) {
      html.paragraph(
          fmt::format("No axis was measured ({}); the geometry is that of the robot's description.",
                      frames.axes.front().reason));
      return;
    }
    Notes notes;
    writeTable(html, linkTable(frames, notes));
    html.paragraph("± is one standard uncertainty (k = 1).", "faint");
    notes.write(html);
    writeTable(html, axisTable(frames));
    html.list(unmeasured);
  });
}

}  // namespace stiffscope::page
