#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identification/estimate.h"
#include "core/identification/remarks.h"
#include "core/identification/subsets.h"
#include "core/io/units.h"
#include "reports/page/html.h"
#include "reports/page/sections.h"
#include "reports/words/day_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/paper_values.h"
#include "reports/words/remark_words.h"

namespace stiffscope::page {

namespace {

int jointsOf(const identification::Identification& result) {
  return static_cast<int>(result.identifiability.joints.size());
}

std::string unavailable(const identification::Identification& result, identification::Method method) {
  return fmt::format("{} is not available: {}.", reports::longName(method), reports::words(result.of(method).reason));
}

std::string markNote(const Remark& mark) {
  return mark.is(identification::RemarkId::negative)
             ? "Negative: the data fits this joint with a stiffness that no spring has; "
               "printed as found, not clamped."
             : "Imprecise: the uncertainty U exceeds twice the value.";
}

/// Why a joint is not seen; with effects in the model the axes are not those that the audit has the torque about.
std::string unseenNote(const reports::ReportCampaign& campaign, int joint) {
  const Remark& reason = campaign.identification.identifiability.joints[static_cast<std::size_t>(joint)].reason;
  const bool effects = campaign.improved != nullptr && !campaign.improved->effects.added.empty();
  return fmt::format("{} is not seen: {}.{}", reports::jointName(joint), reports::words(reason),
                     effects ? " The torque is about the axis of the model with its effects; the audit's (@{Audit}) is "
                               "about that of joint springs alone."
                             : "");
}

reports::Cell stiffnessCell(const reports::ReportCampaign& campaign, identification::Method method, int joint,
                            const reports::StiffnessUnit& unit, Notes& notes) {
  const identification::Identification& result = campaign.identification;
  const identification::MethodResult& one = result.of(method);
  if (!one.available) return {"not available", notes.mark(unavailable(result, method))};
  if (!one.estimate.identifiable[static_cast<std::size_t>(joint)])
    return {"not seen", notes.mark(unseenNote(campaign, joint))};
  const std::string value = reports::uncertainStiffness(one.estimate, joint, unit.size);
  const Remark mark = one.estimate.mark(joint);
  return mark.empty() ? reports::Cell(value)
                      : reports::Cell(value, fmt::format("{} {}", reports::words(mark), notes.mark(markNote(mark))));
}

/// A row a joint and method; what is not identifiable has no numbers but its reason.
reports::DataTable stiffnessData(const identification::Identification& result) {
  reports::DataTable data{{"joint", "method", "identifiable", "stiffness_nm_per_rad", "u_nm_per_rad", "low_nm_per_rad",
                           "high_nm_per_rad", "mark", "reason"},
                          {}};
  for (int joint = 0; joint < jointsOf(result); ++joint) {
    for (const identification::Method method : identification::kMethods) {
      const identification::MethodResult& one = result.of(method);
      const bool there = one.available && one.estimate.identifiable[static_cast<std::size_t>(joint)];
      std::vector<reports::DataCell> row{joint + 1.0, std::string(reports::namesOf(method).key), there ? 1.0 : 0.0};
      if (there) {
        const identification::CoverageInterval interval = identification::stiffnessInterval(one.estimate, joint);
        row.insert(row.end(), {one.estimate.stiffness(joint), identification::expandedUncertainty(one.estimate, joint),
                               interval.low, interval.high, reports::words(one.estimate.mark(joint)), std::string()});
      } else {
        row.resize(row.size() + 5);
        row.emplace_back(one.available
                             ? reports::words(result.identifiability.joints[static_cast<std::size_t>(joint)].reason)
                             : reports::words(one.reason));
      }
      data.rows.push_back(std::move(row));
    }
  }
  return data;
}

reports::Table stiffnessTable(const reports::ReportCampaign& campaign, Notes& notes) {
  const identification::Identification& result = campaign.identification;
  const reports::StiffnessUnit unit = reports::stiffnessUnit(result);
  reports::Table table{fmt::format("Joint stiffness k ± U, {}, from all postures", unit.name), {"Joint"}, {{}}};
  table.id = "stiffness";
  table.data = stiffnessData(result);
  for (const identification::Method method : identification::kMethods)
    table.columns.push_back(reports::longName(method));
  for (int joint = 0; joint < jointsOf(result); ++joint) {
    reports::Row row{reports::jointName(joint)};
    for (const identification::Method method : identification::kMethods)
      row.push_back(stiffnessCell(campaign, method, joint, unit, notes));
    table.groups.front().rows.push_back(std::move(row));
  }
  return table;
}

/// Compliances are what the methods solve for: their uncertainty is symmetric where a stiffness's is not.
reports::Table complianceTable(const identification::Identification& result) {
  const bool soft = reports::stiffnessUnit(result).size < reports::kMega;
  const double times = soft ? 1e6 : 1e9;
  reports::Table table{fmt::format("Joint compliance c ± U, {}\u00a0rad/Nm", soft ? "10⁻⁶" : "10⁻⁹"), {"Joint"}, {{}}};
  table.id = "compliance";
  reports::DataTable& data = table.data.emplace();
  data.columns = {"joint", "method", "compliance_rad_per_nm", "u_rad_per_nm", "low_rad_per_nm", "high_rad_per_nm"};
  for (const identification::Method method : identification::kMethods) {
    if (result.of(method).available) table.columns.push_back(reports::longName(method));
  }
  for (int joint = 0; joint < jointsOf(result) && table.columns.size() > 1; ++joint) {
    if (!result.identifiability.joints[static_cast<std::size_t>(joint)].identifiable) continue;
    reports::Row row{fmt::format("1/{}", reports::jointName(joint))};
    for (const identification::Method method : identification::kMethods) {
      const identification::StiffnessEstimate& estimate = result.of(method).estimate;
      if (!result.of(method).available) continue;
      const identification::CoverageInterval interval = identification::complianceInterval(estimate, joint);
      const double c = estimate.compliance[joint];
      const double expanded = std::max(interval.high - c, c - interval.low);
      row.emplace_back(reports::withUncertainty(times * c, times * expanded));
      data.rows.push_back(
          {joint + 1.0, std::string(reports::namesOf(method).key), c, expanded, interval.low, interval.high});
    }
    table.groups.front().rows.push_back(std::move(row));
  }
  return table;
}

reports::Table fitTable(const identification::Identification& result) {
  reports::Table table{
      "The fits", {"Method", "Condition number", "rms residual (mm)", "Over degrees of freedom (mm)"}, {{}}};
  table.id = "fits";
  for (const identification::Method method : identification::kMethods) {
    if (!result.of(method).available) continue;
    const identification::StiffnessEstimate& estimate = result.of(method).estimate;
    table.groups.front().rows.push_back({reports::longName(method), reports::significant(estimate.condition, 3),
                                         reports::significant(estimate.rms_residual / io::kMillimetre, 3),
                                         reports::significant(estimate.sigma / io::kMillimetre, 3)});
  }
  return table;
}

/// CP's result against the characteristic length, which is not unique.
reports::Table lengthTable(const identification::Identification& result) {
  const reports::StiffnessUnit unit = reports::stiffnessUnit(result);
  reports::Table table{
      fmt::format("Complete Pose against the characteristic length L: stiffness in {}, share compensated on postures "
                  "held out (its standard deviation over the subsets) in %",
                  unit.name),
      {"L (m)", "Condition"},
      {{}}};
  table.id = "characteristic-length";
  reports::DataTable& data = table.data.emplace();
  data.columns = {"length_m", "jacobian_condition"};
  for (int joint = 0; joint < jointsOf(result); ++joint)
    data.columns.push_back(fmt::format("k{}_nm_per_rad", joint + 1));
  for (const char* column : {"held_out_at_wrist_percent", "sd_at_wrist_percent", "held_out_at_reflectors_percent",
                             "sd_at_reflectors_percent", "chosen_by"})
    data.columns.emplace_back(column);
  const identification::MethodResult& own = result.of(identification::Method::complete_pose);
  const auto& seen = result.of(identification::Method::complete_pose).estimate.identifiable;
  for (int joint = 0; joint < jointsOf(result); ++joint) {
    if (seen[static_cast<std::size_t>(joint)]) table.columns.push_back(reports::jointName(joint));
  }
  table.columns.insert(table.columns.end(), {"At P_{wrist}", "At the reflectors", "Chosen by"});
  const auto share = [](const std::optional<identification::Compensation>& at) {
    if (!at || !std::isfinite(at->held_out_sd)) return std::string("–");
    return fmt::format("{} ({})", reports::fixed(100.0 * at->subsets.held_out, 1),
                       reports::fixed(100.0 * at->held_out_sd, 1));
  };
  const auto add = [&](const identification::LengthSensitivity& at, const char* chosen_by) {
    reports::Row row{reports::significant(at.length, 3), reports::significant(at.condition, 3)};
    for (int joint = 0; joint < jointsOf(result); ++joint) {
      if (seen[static_cast<std::size_t>(joint)])
        row.emplace_back(reports::significant(1.0 / (unit.size * at.compliance[joint]), 3));
    }
    for (const auto& cell : {share(at.at_wrist), share(at.at_targets), std::string(chosen_by)}) row.emplace_back(cell);
    table.groups.front().rows.push_back(std::move(row));
    std::vector<reports::DataCell> cells{at.length, at.condition};
    for (int joint = 0; joint < jointsOf(result); ++joint)
      cells.push_back(seen[static_cast<std::size_t>(joint)] ? reports::DataCell(1.0 / at.compliance[joint])
                                                            : reports::DataCell());
    for (const auto& judged : {at.at_wrist, at.at_targets}) {
      const bool there = judged && std::isfinite(judged->held_out_sd);
      cells.push_back(there ? reports::DataCell(100.0 * judged->subsets.held_out) : reports::DataCell());
      cells.push_back(there ? reports::DataCell(100.0 * judged->held_out_sd) : reports::DataCell());
    }
    cells.emplace_back(std::string(chosen_by));
    data.rows.push_back(std::move(cells));
  };
  constexpr std::size_t kEvery = 2;  // a dozen rows would say no more
  for (std::size_t i = 0; i < result.length_sensitivity.size(); i += kEvery) add(result.length_sensitivity[i], "");
  if (!own.available) return table;
  identification::LengthSensitivity chosen;
  chosen.length = result.characteristic_length.length;
  chosen.condition = result.characteristic_length.condition;
  chosen.compliance = own.estimate.compliance;
  chosen.at_wrist = own.at_wrist;
  chosen.at_targets = own.at_targets;
  add(chosen, "least condition number: CP of this page");
  if (result.residual_length) add(*result.residual_length, "residual variances");
  return table;
}

std::string range(const std::string& low, const std::string& high) {
  return low == high ? low : fmt::format("{} to {}", low, high);
}

/// One decimal where it matters to Student's t.
std::string degrees(double of_freedom) {
  return of_freedom < 100.0 ? reports::fixed(of_freedom, 1) : reports::significant(of_freedom, 3);
}

std::string uncertaintyWords(const identification::Identification& result) {
  if (reports::hiddenIsHeld(result)) {
    return "± is the expanded uncertainty U, coverage about 95\u00a0%: the farther end of the interval that holds the "
           "scatter between postures, what they all share (frames, wrist radii, calibrated geometry), and what effects "
           "in the model or beside it could still do to each joint.";
  }
  std::vector<std::string> factors;
  for (const identification::Method method : identification::kMethods) {
    const identification::StiffnessEstimate& estimate = result.of(method).estimate;
    reports::Coverage least{std::numeric_limits<double>::infinity(), 0.0}, most;
    for (int joint = 0; joint < estimate.joints() && result.of(method).available; ++joint) {
      if (!estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
      const reports::Coverage own = reports::coverageOf(estimate, joint);
      if (own.factor < least.factor) least = own;
      if (own.factor > most.factor) most = own;
    }
    if (most.factor == 0.0) continue;
    const std::string freedom = range(degrees(most.degrees_of_freedom), degrees(least.degrees_of_freedom));
    factors.push_back(fmt::format("{} for {} ({} degree{} of freedom)",
                                  range(reports::fixed(least.factor, 2), reports::fixed(most.factor, 2)),
                                  reports::shortName(method), freedom, freedom == "1.0" ? "" : "s"));
  }
  if (factors.empty()) return "Too few postures for an uncertainty.";
  return fmt::format(
      "± is the expanded uncertainty U = k u, coverage about 95\u00a0%, with the coverage factor k from Student's t, "
      "joint by joint: {}. The standard uncertainty u is from the scatter between postures and from what they all "
      "share: frames, wrist radii, calibrated geometry.",
      fmt::join(factors, ", "));
}

/// What the cells say whose interval is far from symmetric, or open; empty where there is none.
std::string bracketWords(const identification::Identification& result) {
  bool any = false, open = false;
  for (const identification::Method method : identification::kMethods) {
    const identification::StiffnessEstimate& estimate = result.of(method).estimate;
    for (int joint = 0; joint < estimate.joints() && result.of(method).available; ++joint) {
      if (!estimate.identifiable[static_cast<std::size_t>(joint)] || !reports::farFromSymmetric(estimate, joint))
        continue;
      any = true;
      open = open || !std::isfinite(identification::stiffnessInterval(estimate, joint).high);
    }
  }
  if (!any) return {};
  return fmt::format("In brackets: the 95\u00a0% interval itself, where it is far from symmetric.{}",
                     open ? " Above: the joint's compliance may be zero, so that the data only say how stiff it is at "
                            "least."
                          : "");
}

}  // namespace

void writeStiffness(Html& html, const reports::ReportContent& content) {
  writeForEach(html, content, "stiffness", "Joint stiffness", isLoaded, [&](const reports::ReportCampaign& one) {
    Notes notes;
    writeTable(html, stiffnessTable(one, notes));
    writeTable(html, complianceTable(one.identification));
    html.paragraph(uncertaintyWords(one.identification), "faint");
    if (const std::string brackets = bracketWords(one.identification); !brackets.empty())
      html.paragraph(brackets, "faint");
    notes.write(html);
    if (reports::shownMethod(one.identification) && !reports::anyPositiveStiffness(one.identification)) {
      html.paragraph(
          "There is no picture of the stiffnesses: none is positive, and a logarithmic axis has no place for "
          "others.");
    }
    writeTable(html, fitTable(one.identification));
    if (reports::shownMethod(one.identification)) {
      html.paragraph(
          "Residuals per coordinate, of the positions that the method fits: P_{TCP} for CP, the reflectors "
          "for PP and DPP.",
          "faint");
    }
    writeTable(html, lengthTable(one.identification));
  });
}

namespace {

reports::Row spreadRow(const reports::ReportContent& content, const reports::ReportCampaign& one,
                       identification::Method method, int joint, const reports::StiffnessUnit& unit) {
  const identification::StiffnessSpread spread = identification::spreadOf(one.identification.of(method).subsets, joint);
  const double width = (spread.high - spread.low) / unit.size;
  reports::Row row{reports::shortName(method), reports::withUncertainty(spread.mean / unit.size, spread.sd / unit.size),
                   reports::toPlaceOf(spread.median / unit.size, width),
                   fmt::format("{} to {}", reports::toPlaceOf(spread.low / unit.size, width),
                               reports::toPlaceOf(spread.high / unit.size, width)),
                   reports::percent(spread.share_negative)};
  if (content.compare_with_paper) {
    const auto paper = reports::paperStiffness(one.campaign, method, joint);
    const double printed = reports::kMega / unit.size;
    row.emplace_back(paper ? fmt::format("{} & {}", reports::asPrinted(printed * paper->mean),
                                         reports::asPrinted(printed * paper->sd))
                           : "–");
  }
  return row;
}

reports::Table tableTwo(const reports::ReportContent& content, const reports::ReportCampaign& one,
                        const identification::SubsetStudy& any) {
  const reports::StiffnessUnit unit = reports::stiffnessUnit(one.identification);
  reports::Table table{fmt::format("Table II: joint stiffness over {}, {}", reports::subsetWords(any), unit.name),
                       {"Joint", "Method", "Mean ± sd", "Median", "5 to 95\u00a0%", "Negative"},
                       {}};
  table.id = "subsets";
  reports::DataTable& data = table.data.emplace();
  data.columns = {
      "joint",          "method",          "mean_nm_per_rad",  "sd_nm_per_rad",         "median_nm_per_rad",
      "low_nm_per_rad", "high_nm_per_rad", "negative_percent", "paper_mean_nm_per_rad", "paper_sd_nm_per_rad"};
  if (content.compare_with_paper) table.columns.emplace_back("Paper, mean & sd");
  for (int joint = 0; joint < jointsOf(one.identification); ++joint) {
    reports::RowGroup group{reports::jointName(joint), {}};
    for (const identification::Method method : identification::kMethods) {
      const identification::MethodResult& result = one.identification.of(method);
      const bool there = result.available && result.estimate.identifiable[static_cast<std::size_t>(joint)] &&
                         !result.subsets.compliances.empty();
      if (!there) continue;
      group.rows.push_back(spreadRow(content, one, method, joint, unit));
      const identification::StiffnessSpread spread = identification::spreadOf(result.subsets, joint);
      const auto paper =
          content.compare_with_paper ? reports::paperStiffness(one.campaign, method, joint) : std::nullopt;
      data.rows.push_back({joint + 1.0, std::string(reports::namesOf(method).key), spread.mean, spread.sd,
                           spread.median, spread.low, spread.high, 100.0 * spread.share_negative,
                           paper ? reports::DataCell(reports::kMega * paper->mean) : reports::DataCell(),
                           paper ? reports::DataCell(reports::kMega * paper->sd) : reports::DataCell()});
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

}  // namespace

void writeSubsets(Html& html, const reports::ReportContent& content) {
  writeForEach(
      html, content, "subsets", "Spread over subsets of postures", isLoaded, [&](const reports::ReportCampaign& one) {
        const auto shown = reports::shownMethod(one.identification);
        if (!shown) {
          html.paragraph("No method is available, so there is no spread to show.");
          return;
        }
        const identification::SubsetStudy& study = one.identification.of(*shown).subsets;
        if (study.compliances.empty()) {
          html.paragraph(fmt::format("{} postures are too few to draw subsets from.", one.identification.cases.size()));
          return;
        }
        writeTable(html, tableTwo(content, one, study));
        html.paragraph(
            "A stiffness is one over a compliance: where the compliance comes near zero in some "
            "subsets, the mean of the stiffness is carried off by a few of them, and the median is the "
            "number to read.",
            "faint");
      });
}

}  // namespace stiffscope::page
