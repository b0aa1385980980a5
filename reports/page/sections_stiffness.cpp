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
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/paper_values.h"
#include "reports/words/remark_words.h"

namespace stiffscope::page {

namespace {

reports::Row shareRow(const reports::ReportContent& content, const reports::ReportCampaign& campaign,
                      identification::Method method, bool at_wrist) {
  const identification::MethodResult& one = campaign.identification.of(method);
  const identification::Compensation& compensation = *reports::compensationAt(one, at_wrist);
  const bool subsets = !one.subsets.compliances.empty();
  const auto ofSubsets = [&](double share) { return subsets ? reports::percent(share) : std::string("–"); };
  reports::Row row{reports::shortName(method), reports::percent(compensation.all_postures),
                   ofSubsets(compensation.subsets.used), ofSubsets(compensation.subsets.held_out),
                   ofSubsets(compensation.subsets.all)};
  if (content.compare_with_paper) {
    // The paper compensates what the active double encoders leave, and judges at P_wrist.
    const bool comparable = at_wrist && campaign.campaign.double_encoder == campaign::DoubleEncoder::active;
    row.emplace_back(comparable ? reports::percent(reports::kPaperCompensated[static_cast<std::size_t>(method)], 0)
                                : "–");
  }
  return row;
}

reports::Table shareTable(const reports::ReportContent& content, const reports::ReportCampaign& one) {
  reports::Table table{
      "Share of the deflection compensated",
      {"At", "Method", "All postures: fitted and judged", "Subsets: used", "Subsets: held out", "Subsets: all"},
      {}};
  table.id = "compensation";
  if (content.compare_with_paper) table.columns.emplace_back("Paper: all");
  for (const bool at_wrist : {true, false}) {
    reports::RowGroup group{at_wrist ? "P_{wrist}" : "Reflectors", {}};
    for (const identification::Method method : identification::kMethods) {
      const identification::MethodResult& result = one.identification.of(method);
      if (result.available && reports::compensationAt(result, at_wrist)) {
        group.rows.push_back(shareRow(content, one, method, at_wrist));
      }
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

/// Both points side by side, with the spread over the subsets.
reports::Table heldOutTable(const identification::Identification& result) {
  reports::Table table{"Share compensated on postures held out, and its standard deviation over the subsets, %",
                       {"Method", "At the reflectors", "sd at the reflectors", "At P_{wrist}", "sd at P_{wrist}"},
                       {{}}};
  table.id = "held-out";
  for (const identification::Method method : identification::kMethods) {
    const identification::MethodResult& one = result.of(method);
    if (!one.available || one.subsets.compliances.empty()) continue;
    reports::Row row{reports::shortName(method)};
    for (const bool at_wrist : {false, true}) {
      const auto& share = reports::compensationAt(one, at_wrist);
      row.emplace_back(share ? reports::fixed(100.0 * share->subsets.held_out, 2) : "–");
      row.emplace_back(share && std::isfinite(share->held_out_sd) ? reports::fixed(100.0 * share->held_out_sd, 2)
                                                                  : "–");
    }
    table.groups.front().rows.push_back(std::move(row));
  }
  return table;
}

std::string noiseWords(const reports::ReportCampaign& one) {
  const identification::Identification& result = one.identification;
  if (!result.noise) {
    return fmt::format("What noise alone forbids is not known: {}.",
                       one.campaign.tracker ? "the campaign has displacements only, not the readings they come from"
                                            : "the tracker's noise is not declared");
  }
  const std::string at_targets = reports::percent(result.noise->at_targets);
  if (!result.noise->at_wrist) {
    return fmt::format("Noise of the tracker alone forbids about {} at the reflectors: no model can take that away.",
                       at_targets);
  }
  return fmt::format(
      "Noise of the tracker alone forbids about {} at P_{{wrist}} and {} at the reflectors: no model can take that "
      "away.",
      reports::percent(*result.noise->at_wrist), at_targets);
}

std::string withU(const comparison::Uncertain& number, double times) {
  return std::isfinite(number.value) ? reports::withUncertainty(times * number.value, times * number.expanded()) : "–";
}

std::string pWords(double p) {
  if (!std::isfinite(p)) return "–";
  return p < 1e-4 ? "< 0.0001" : reports::fixed(p, 4);
}

/// What the active encoders take away, joint by joint.
reports::Table takenTable(const reports::AvoidedByEncoders& avoided) {
  reports::Table table{fmt::format("What the double encoders take away ± U, by {}", reports::longName(avoided.method)),
                       {"Joint", "Compliance 1/k, 10⁻⁹\u00a0rad/Nm", "Share of it, %",
                        "Of the deflection at the reflectors, %", "p (Holm)"},
                       {{}}};
  table.id = "taken-away";
  for (std::size_t j = 0; j < 6; ++j) {
    const comparison::JointChange& joint = avoided.by_joint.joints[j];
    if (!joint.comparable) continue;
    const comparison::Uncertain gone{-joint.difference.value, joint.difference.sd, joint.difference.dof};
    table.groups.front().rows.push_back({fmt::format("1/{}", reports::jointName(static_cast<int>(j))), withU(gone, 1e9),
                                         withU(joint.taken, 100.0), withU(joint.avoided, 100.0), pWords(joint.p_holm)});
  }
  return table;
}

void writeTaken(Html& html, const reports::AvoidedByEncoders& avoided) {
  if (!avoided.by_joint.available) return;
  writeTable(html, takenTable(avoided));
  std::string words = avoided.by_joint.same_postures
                          ? fmt::format(
                                "Differences of compliances fitted on the {} postures of both states: what both "
                                "share cancels.",
                                avoided.by_joint.postures)
                      : avoided.by_joint.by_models
                          ? std::string("Differences of the compliances of each day's own model.")
                          : std::string(
                                "Differences of compliances fitted on other postures: what the model misses does not "
                                "cancel.");
  if (!avoided.residual_is_noise) {
    words +=
        " What joint springs leave is more than noise, or not known to be noise: shares are of the apparent "
        "compliance, "
        "which holds what else gives as the joint does.";
  }
  html.paragraph(words, "faint");
}

void writeAvoided(Html& html, const reports::ReportContent& content) {
  std::string words;
  if (!content.avoided) return;  // the two states were not both measured: there is nothing to explain
  if (content.avoided->available) {
    words = fmt::format(
        "With the double encoders active the deflection at {} is smaller than with them inactive by {}, over {} "
        "postures at the same joint angles under the same load; the interval is of what other postures would give.",
        reports::pointOf(*content.avoided), reports::shareWords(*content.avoided), content.avoided->postures.size());
    if (content.compare_with_paper)
      words += fmt::format(" The paper: {}.", reports::percent(reports::kPaperAvoided, 0));
  } else {
    words = fmt::format("Not known: {}.", reports::words(content.avoided->reason));
  }
  html.leaf("h3", "Avoided by the double encoders");
  html.paragraph(words);
  writeTaken(html, *content.avoided);
}

}  // namespace

void writeCompensation(Html& html, const reports::ReportContent& content) {
  const auto section = html.element("section", {{"id", "compensation"}});
  html.leaf("h2", "Deflection compensated and avoided");
  html.paragraph(
      "Compensated is 1 − Σ|what is left| / Σ|displacement|. Over the subsets of postures it is "
      "the mean: on the postures a subset used, on those it held out, and on all. P_{wrist} sees "
      "joints 1 to 3 only, the reflectors all six.");
  writeAvoided(html, content);
  writeEach(html, content, "compensation", isLoaded, [&](const reports::ReportCampaign& one) {
    if (!reports::shownMethod(one.identification)) {
      html.paragraph("No method is available, so nothing is compensated.");
      return;
    }
    if (one.identification.shown_first)
      html.paragraph(reports::asIs(reports::shownFirstWords(one.identification, *one.identification.shown_first)));
    if (const reports::Table held_out = heldOutTable(one.identification); !held_out.groups.front().rows.empty())
      writeTable(html, held_out);
    writeTable(html, shareTable(content, one));
    if (one.identification.wrist_displacement.empty()) {
      html.paragraph("P_{wrist} is not measured in the load states: shares are given at the reflectors.");
    }
    html.paragraph(noiseWords(one));
  });
}

namespace {

std::string unavailable(const identification::Identification& result, identification::Method method) {
  return fmt::format("{} is not available: {}.", reports::longName(method), reports::words(result.of(method).reason));
}

std::string markNote(const Remark& mark) {
  return mark.is(identification::RemarkId::negative)
             ? "Negative: the data fits this joint with a stiffness that no spring has; "
               "printed as found, not clamped."
             : "Imprecise: the standard uncertainty exceeds the value.";
}

reports::Cell stiffnessCell(const identification::Identification& result, identification::Method method, int joint,
                            Notes& notes) {
  const identification::MethodResult& one = result.of(method);
  if (!one.available) return {"not available", notes.mark(unavailable(result, method))};
  if (!one.estimate.identifiable[static_cast<std::size_t>(joint)]) {
    const Remark& reason = result.identifiability.joints[static_cast<std::size_t>(joint)].reason;
    return {"not identifiable",
            notes.mark(fmt::format("{} is not identifiable: {}.", reports::jointName(joint), reports::words(reason)))};
  }
  const double expanded = reports::coverageOf(one.estimate, joint).factor * one.estimate.stiffnessSd(joint);
  const std::string value =
      reports::withUncertainty(one.estimate.stiffness(joint) / reports::kMega, expanded / reports::kMega);
  const Remark mark = one.estimate.mark(joint);
  return mark.empty() ? reports::Cell(value)
                      : reports::Cell(value, fmt::format("{} {}", reports::words(mark), notes.mark(markNote(mark))));
}

reports::Table stiffnessTable(const identification::Identification& result, Notes& notes) {
  reports::Table table{"Joint stiffness k ± U, 10⁶\u00a0Nm/rad, from all postures", {"Joint"}, {{}}};
  table.id = "stiffness";
  for (const identification::Method method : identification::kMethods)
    table.columns.push_back(reports::longName(method));
  for (int joint = 0; joint < 6; ++joint) {
    reports::Row row{reports::jointName(joint)};
    for (const identification::Method method : identification::kMethods)
      row.push_back(stiffnessCell(result, method, joint, notes));
    table.groups.front().rows.push_back(std::move(row));
  }
  return table;
}

/// Compliances are what the methods solve for: their uncertainty is symmetric where a stiffness's is not.
reports::Table complianceTable(const identification::Identification& result) {
  reports::Table table{"Joint compliance c ± U, 10⁻⁹\u00a0rad/Nm", {"Joint"}, {{}}};
  table.id = "compliance";
  for (const identification::Method method : identification::kMethods) {
    if (result.of(method).available) table.columns.push_back(reports::longName(method));
  }
  for (int joint = 0; joint < 6 && table.columns.size() > 1; ++joint) {
    if (!result.identifiability.joints[static_cast<std::size_t>(joint)].identifiable) continue;
    reports::Row row{fmt::format("1/{}", reports::jointName(joint))};
    for (const identification::Method method : identification::kMethods) {
      const identification::StiffnessEstimate& estimate = result.of(method).estimate;
      if (!result.of(method).available) continue;
      const identification::CoverageInterval interval = identification::complianceInterval(estimate, joint);
      const double c = estimate.compliance[joint];
      row.emplace_back(reports::withUncertainty(1e9 * c, 1e9 * std::max(interval.high - c, c - interval.low)));
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
  reports::Table table{
      "Complete Pose against the characteristic length L: stiffness in 10⁶\u00a0Nm/rad, share compensated on postures "
      "held out (its standard deviation over the subsets) in %",
      {"L (m)", "Condition"},
      {{}}};
  table.id = "characteristic-length";
  const identification::MethodResult& own = result.of(identification::Method::complete_pose);
  const auto& seen = result.of(identification::Method::complete_pose).estimate.identifiable;
  for (int joint = 0; joint < 6; ++joint) {
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
    for (int joint = 0; joint < 6; ++joint) {
      if (seen[static_cast<std::size_t>(joint)]) row.emplace_back(reports::significant(1e-6 / at.compliance[joint], 3));
    }
    for (const auto& cell : {share(at.at_wrist), share(at.at_targets), std::string(chosen_by)}) row.emplace_back(cell);
    table.groups.front().rows.push_back(std::move(row));
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
  const bool weighed = std::any_of(result.methods.begin(), result.methods.end(),
                                   [](const auto& method) { return !method.estimate.stated.empty(); });
  if (weighed) {
    return "± is the expanded uncertainty U, coverage about 95\u00a0%: the farther end of the interval that holds the "
           "scatter between postures, what they all share (frames, wrist radii, calibrated geometry), and what effects "
           "in "
           "the model or beside it could still do to each joint.";
  }
  std::vector<std::string> factors;
  for (const identification::Method method : identification::kMethods) {
    const identification::StiffnessEstimate& estimate = result.of(method).estimate;
    reports::Coverage least{std::numeric_limits<double>::infinity(), 0.0}, most;
    for (int joint = 0; joint < 6 && result.of(method).available; ++joint) {
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
      "joint by "
      "joint: {}. The standard uncertainty u is from the scatter between postures and from what they all share: "
      "frames, "
      "wrist radii, calibrated geometry.",
      fmt::join(factors, ", "));
}

/// Where the interval of the stiffness is far from symmetric, or open.
std::string wideIntervals(const identification::Identification& result) {
  std::vector<std::string> wide;
  for (const identification::Method method : identification::kMethods) {
    const identification::StiffnessEstimate& estimate = result.of(method).estimate;
    for (int joint = 0; joint < 6 && result.of(method).available; ++joint) {
      if (!estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
      const identification::CoverageInterval compliance = identification::complianceInterval(estimate, joint);
      const double c = estimate.compliance[joint];
      constexpr double kWide = 0.2;
      if (!std::isfinite(compliance.low) || compliance.high - c < kWide * std::abs(c)) continue;
      const identification::CoverageInterval own = identification::stiffnessInterval(compliance);
      wide.push_back(std::isfinite(own.high)
                         ? fmt::format("{} by {} is between {} and {}", reports::jointName(joint),
                                       reports::shortName(method), reports::significant(own.low / reports::kMega, 3),
                                       reports::significant(own.high / reports::kMega, 3))
                         : fmt::format("{} by {} is only known to be above {}", reports::jointName(joint),
                                       reports::shortName(method), reports::significant(own.low / reports::kMega, 3)));
    }
  }
  if (wide.empty()) return {};
  return fmt::format("Wide 95\u00a0% intervals, 10⁶\u00a0Nm/rad: {}.", fmt::join(wide, "; "));
}

}  // namespace

void writeStiffness(Html& html, const reports::ReportContent& content) {
  writeForEach(html, content, "stiffness", "Joint stiffness", isLoaded, [&](const reports::ReportCampaign& one) {
    Notes notes;
    writeTable(html, stiffnessTable(one.identification, notes));
    html.paragraph(uncertaintyWords(one.identification), "faint");
    if (const std::string wide = wideIntervals(one.identification); !wide.empty()) html.paragraph(wide);
    notes.write(html);
    writeTable(html, complianceTable(one.identification));
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
                       identification::Method method, int joint) {
  const identification::StiffnessSpread spread = identification::spreadOf(one.identification.of(method).subsets, joint);
  const double width = (spread.high - spread.low) / reports::kMega;
  reports::Row row{reports::shortName(method),
                   reports::withUncertainty(spread.mean / reports::kMega, spread.sd / reports::kMega),
                   reports::toPlaceOf(spread.median / reports::kMega, width),
                   fmt::format("{} to {}", reports::toPlaceOf(spread.low / reports::kMega, width),
                               reports::toPlaceOf(spread.high / reports::kMega, width)),
                   reports::percent(spread.share_negative)};
  if (content.compare_with_paper) {
    const auto paper = reports::paperStiffness(one.campaign.double_encoder, method, joint);
    row.emplace_back(paper ? fmt::format("{} & {}", reports::asPrinted(paper->mean), reports::asPrinted(paper->sd))
                           : "–");
  }
  return row;
}

reports::Table tableTwo(const reports::ReportContent& content, const reports::ReportCampaign& one,
                        const identification::SubsetStudy& any) {
  reports::Table table{fmt::format("Table II: joint stiffness over {}, 10⁶\u00a0Nm/rad", reports::subsetWords(any)),
                       {"Joint", "Method", "Mean ± sd", "Median", "5 to 95\u00a0%", "Negative"},
                       {}};
  table.id = "subsets";
  if (content.compare_with_paper) table.columns.emplace_back("Paper, mean & sd");
  for (int joint = 0; joint < 6; ++joint) {
    reports::RowGroup group{reports::jointName(joint), {}};
    for (const identification::Method method : identification::kMethods) {
      const identification::MethodResult& result = one.identification.of(method);
      const bool there = result.available && result.estimate.identifiable[static_cast<std::size_t>(joint)] &&
                         !result.subsets.compliances.empty();
      if (there) group.rows.push_back(spreadRow(content, one, method, joint));
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
