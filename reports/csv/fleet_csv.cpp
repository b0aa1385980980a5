#include "reports/csv/fleet_csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "reports/csv/csv_table.h"
#include "reports/json/campaign_json.h"
#include "reports/json/fleet_json.h"
#include "reports/json/json.h"
#include "reports/words/fleet_words.h"
#include "reports/words/names.h"
#include "reports/words/remark_words.h"
#include "reports/words/rich_text.h"

namespace stiffscope::reports {

namespace {

using DataRow = std::vector<DataCell>;

void addColumns(DataTable& table, const std::string& name, const std::string& unit) {
  const std::string end = unit.empty() ? "" : "_" + unit;
  for (const char* part : {"", "_low", "_high"}) table.columns.push_back(name + part + end);
}

void addStated(DataRow& row, const fleet::Stated& one) { row.insert(row.end(), {one.value, one.low, one.high}); }

void addEmpty(DataRow& row, std::size_t count) { row.insert(row.end(), count, std::monostate()); }

/// `joints`: whose columns the table has.
void addCampaign(DataRow& row, const fleet::CampaignResult& one, int joints) {
  row.insert(row.end(), {std::string(keyOf(one.kind)), std::string(nameOf(one.encoders)),
                         std::string(nameOf(one.audit)), static_cast<double>(one.postures)});
  row.push_back(one.method ? DataCell(std::string(namesOf(*one.method).key)) : DataCell());
  for (const fleet::Stated& k : one.stiffness) addStated(row, k);
  addEmpty(row, 3 * (static_cast<std::size_t>(joints) - one.stiffness.size()));
  row.push_back(one.deflection);
  addStated(row, one.compensated);
  addStated(row, one.nominal);
  addStated(row, one.calibrated);
  row.insert(row.end(), {one.gap_before, one.gap_noise, one.gap_after});
  row.push_back(one.diagnosed ? effectsKey(one) : std::string());
}

}  // namespace

std::string fleetCsv(const fleet::Fleet& fleet) {
  DataTable table{{"machine", "date", "folder", "failure", "kind", "double_encoders", "audit", "postures", "method"},
                  {}};
  const int joints = mostJointsOf(fleet);
  for (int j = 1; j <= joints; ++j) addColumns(table, fmt::format("k{}", j), "nm_per_rad");
  table.columns.emplace_back("deflection_m");
  addColumns(table, "compensated", "");
  addColumns(table, "nominal_rms", "m");
  addColumns(table, "calibrated_rms", "m");
  for (const char* name : {"gap_before_m", "gap_noise_m", "gap_after_m", "effects", "report_failure"})
    table.columns.emplace_back(name);
  for (const fleet::FleetCampaign& one : fleet.campaigns) {
    DataRow row{one.machine, one.date, one.folder, one.failure};
    if (one.result) addCampaign(row, *one.result, joints);
    addEmpty(row, table.columns.size() - 1 - row.size());
    row.emplace_back(one.report_failure);
    table.rows.push_back(std::move(row));
  }
  return csvTable(table);
}

std::string changesCsv(const fleet::Fleet& fleet) {
  DataTable table{{"machine", "date_before", "date_after", "quantity", "joint"}, {}};
  addColumns(table, "difference", "rad_per_nm");
  addColumns(table, "taken", "");
  for (const char* name : {"at_reflectors_m", "p_value", "p_holm", "failure"}) table.columns.emplace_back(name);
  for (const fleet::FleetPair& pair : fleet.pairs) {
    const fleet::FleetCampaign &before = fleet.campaigns[pair.before], &after = fleet.campaigns[pair.after];
    const DataRow head{after.machine, before.date, after.date};
    const std::string failure = pair.result ? pair.result->reason : pair.failure;
    if (!failure.empty() || !pair.result || pair.result->kind == fleet::DayKind::unloaded) {
      DataRow row = head;
      row.insert(row.end(), {std::string("geometry"), std::monostate()});
      addEmpty(row, 6);
      row.push_back(pair.result ? DataCell(pair.result->at_targets) : DataCell());
      row.push_back(pair.result ? DataCell(pair.result->machine_p) : DataCell());
      row.insert(row.end(), {pair.machine_p_holm, failure});
      table.rows.push_back(std::move(row));
    }
    if (!pair.result) continue;
    for (std::size_t j = 0; j < pair.result->difference.size(); ++j) {
      if (!std::isfinite(pair.result->difference[j].value)) continue;
      DataRow row = head;
      row.insert(row.end(), {std::string("compliance"), static_cast<double>(j + 1)});
      addStated(row, pair.result->difference[j]);
      addStated(row, pair.result->taken[j]);
      row.insert(row.end(), {std::monostate(), pair.result->p_value[j], pair.p_holm[j], std::monostate()});
      table.rows.push_back(std::move(row));
    }
  }
  return csvTable(table);
}

std::string detectableCsv(const fleet::Fleet& fleet) {
  DataTable table{{"machine", "kind", "double_encoders", "joint", "dates", "same_postures", "compliance_rad_per_nm",
                   "in_the_middle", "on_the_last_date", "machine_of_name"},
                  {}};
  for (const fleet::SeriesCharts& charts : fleet.charts) {
    const fleet::DaySeries& series = fleet.series[charts.series];
    for (std::size_t j = 0; j < charts.joints.size(); ++j) {
      const fleet::Detectable& one = charts.detectable[j];
      table.rows.push_back({series.machine, std::string(keyOf(series.kind)), std::string(nameOf(series.encoders)),
                            static_cast<double>(j + 1), static_cast<double>(series.campaigns.size()),
                            std::string(charts.same_postures ? "yes" : "no"), charts.joints[j].centre, one.middle,
                            one.last, static_cast<double>(machineNumber(fleet, series))});
    }
  }
  return csvTable(table);
}

std::string stepsCsv(const fleet::Fleet& fleet) {
  DataTable table{{"machine", "date", "quantity", "joint", "effects"}, {}};
  addColumns(table, "change", "");
  for (const char* name : {"at_reflectors_m", "p_holm", "dates_before", "dates_after"})
    table.columns.emplace_back(name);
  for (const fleet::FleetStep& step : fleet.steps) {
    using What = fleet::FleetStep::What;
    const bool compliance = step.what == What::compliance;
    const char* quantity = compliance                           ? "compliance"
                           : step.what == What::geometry        ? "geometry"
                           : step.what == What::effect_appeared ? "effect"
                                                                : "effect gone";
    DataRow row{step.machine, fleet.campaigns[step.campaign].date, std::string(quantity)};
    row.push_back(compliance ? DataCell(static_cast<double>(step.compliance.joint + 1)) : DataCell());
    row.push_back(fmt::format("{}", fmt::join(step.effects, "|")));
    if (compliance)
      addStated(row, step.compliance.share());
    else
      addEmpty(row, 3);
    row.insert(row.end(),
               {step.size, step.p_holm, static_cast<double>(step.days_before), static_cast<double>(step.days_after)});
    table.rows.push_back(std::move(row));
  }
  return csvTable(table);
}

std::string needsCsv(const fleet::Fleet& fleet) {
  DataTable table{{"rank", "machine", "need", "date", "reason", "next"}, {}};
  for (std::size_t m = 0; m < fleet.machines.size(); ++m) {
    for (const fleet::Need& need : fleet.machines[m].needs) {
      table.rows.push_back({static_cast<double>(m + 1), fleet.machines[m].name, std::string(keyOf(need.id)),
                            fleet.campaigns[need.campaign].date, plain(words(need.reason)), plain(words(need.next))});
    }
  }
  return csvTable(table);
}

}  // namespace stiffscope::reports
