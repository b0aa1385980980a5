#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "core/identification/estimate.h"
#include "core/io/units.h"
#include "reports/csv/csv_table.h"
#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/transmission_words.h"

namespace stiffscope::page {

namespace {

std::string intervalCell(const identification::CoverageInterval& compliance, const reports::StiffnessUnit& unit) {
  const identification::CoverageInterval stiffness = identification::stiffnessInterval(compliance);
  if (!std::isfinite(stiffness.low)) return "not seen";
  const std::string low = reports::significant(stiffness.low / unit.size, 3);
  if (!std::isfinite(stiffness.high)) return "above " + low;
  return fmt::format("{} to {}", low, reports::significant(stiffness.high / unit.size, 3));
}

reports::Table gearTable(const identification::Identification& result) {
  const identification::Transmission& transmission = *result.transmission;
  const auto shown = reports::shownMethod(result);
  const reports::StiffnessUnit unit = reports::stiffnessUnit(transmission);
  reports::Table table{fmt::format("Gear stiffness k ± U by the two encoders, {}", unit.name),
                       {"Joint", "Gear", "States", "Residual (10⁻⁶\u00a0rad)", "Held under load"},
                       {{}}};
  table.id = "transmission";
  reports::DataTable& data = table.data.emplace();
  data.columns = {"joint",
                  "gear_nm_per_rad",
                  "u_gear_nm_per_rad",
                  "states",
                  "residual_rad",
                  "held_under_load",
                  "structure_low_nm_per_rad",
                  "structure_high_nm_per_rad",
                  "gear_share_percent",
                  "agreement"};
  if (shown) {
    table.columns.push_back(fmt::format("Structure, {}, 95\u00a0%", reports::shortName(*shown)));
    table.columns.emplace_back("Gear's share");
    table.columns.emplace_back("Encoders and tracker");
  }
  for (int joint = 0; joint < transmission.estimate.joints(); ++joint) {
    const identification::GearTorsion& gear = transmission.joints[static_cast<std::size_t>(joint)];
    if (!gear.measured) continue;
    const identification::StiffnessEstimate& gears = transmission.estimate;
    const double expanded = identification::expandedUncertainty(gears, joint);
    reports::Row row{reports::jointName(joint),
                     reports::Cell(reports::withUncertainty(gears.stiffness(joint) / unit.size, expanded / unit.size),
                                   reports::words(gears.mark(joint))),
                     std::to_string(gear.states), reports::significant(1e6 * gear.rms_residual, 3),
                     reports::wordsOf(gear.held)};
    std::vector<reports::DataCell> cells{joint + 1.0,       gears.stiffness(joint),
                                         expanded,          static_cast<double>(gear.states),
                                         gear.rms_residual, std::string(reports::wordsOf(gear.held))};
    cells.resize(data.columns.size());
    if (shown) {
      const auto apart = identification::gearAndStructure(transmission, result.of(*shown).estimate, joint);
      row.emplace_back(apart ? intervalCell(apart->interval, unit) : "–");
      row.emplace_back(apart ? reports::percent(apart->gear_share, 0) : "–");
      row.emplace_back(apart ? reports::wordsOf(apart->agreement) : "–");
    }
    if (const auto apart =
            shown ? identification::gearAndStructure(transmission, result.of(*shown).estimate, joint) : std::nullopt) {
      const identification::CoverageInterval structure = identification::stiffnessInterval(apart->interval);
      cells[6] = structure.low;
      cells[7] = structure.high;
      cells[8] = 100.0 * apart->gear_share;
      cells[9] = std::string(reports::wordsOf(apart->agreement));
    }
    data.rows.push_back(std::move(cells));
    table.groups.front().rows.push_back(std::move(row));
  }
  return table;
}

/// Every state of every joint: too many for the page, kept as a file beside it.
std::string pointsCsv(const campaign::Campaign& campaign, const identification::Transmission& transmission) {
  reports::DataTable table{{"pose", "step", "joint", "torque_nm", "torsion_rad", "residual_rad", "used"}, {}};
  for (const identification::TorsionPoint& point : transmission.points) {
    table.rows.push_back({campaign.pose_ids[static_cast<std::size_t>(point.pose)], static_cast<double>(point.step),
                          point.joint + 1.0, point.torque, point.torsion, point.residual, point.used ? 1.0 : 0.0});
  }
  return reports::csvTable(table);
}

}  // namespace

bool anySecondEncoders(const reports::ReportContent& content) {
  return std::any_of(content.campaigns.begin(), content.campaigns.end(),
                     [](const reports::ReportCampaign& one) { return one.identification.transmission.has_value(); });
}

void writeTransmission(Html& html, const reports::ReportContent& content) {
  if (!anySecondEncoders(content)) return;
  writeForEach(
      html, content, "transmission", "Gears by two encoders", isLoaded, [&](const reports::ReportCampaign& one) {
        const auto& transmission = one.identification.transmission;
        if (!transmission) {
          html.paragraph("No angles of the motors' side beside those of the joints.");
          return;
        }
        html.paragraph(
            "Under load the link runs ahead of its motor by the load's torque over the stiffness of the gear: the two "
            "encoders measure the gear alone, and the tracker takes no part. Where the controller holds the link side "
            "the "
            "tracker sees what lies beyond the gear (bearings, link); where it holds the motor, both in series, and "
            "the "
            "structure is the difference of the compliances.");
        if (transmission->measured()) {
          writeTable(html, gearTable(one.identification));
          html.keepTable("transmission-points", pointsCsv(one.campaign, *transmission));
          html.paragraph(
              "± is the expanded uncertainty U, coverage 95\u00a0%, from the scatter between postures, the measured "
              "axes, "
              "and the declared scale of the load cell. Gear's share: of the compliance of gear and structure in "
              "series.",
              "faint");
        }
        for (const std::string& note : reports::transmissionNotes(*transmission)) html.paragraph(reports::asIs(note));
      });
}

}  // namespace stiffscope::page
