#include <fmt/format.h>

#include "reports/page/html_table.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"
#include "reports/page/paper_values.h"
#include "reports/page/sections.h"

namespace stiffscope::page {

namespace {

Row shareRow(const ReportContent& content, const ReportCampaign& campaign, Method method, bool at_wrist) {
  const MethodResult& one = campaign.identification.of(method);
  const Compensation& compensation = *compensationAt(one, at_wrist);
  const bool subsets = !one.subsets.compliances.empty();
  const auto ofSubsets = [&](double share) { return subsets ? percent(share) : std::string("–"); };
  Row row{shortName(method), percent(compensation.all_postures), ofSubsets(compensation.subsets.used),
          ofSubsets(compensation.subsets.held_out), ofSubsets(compensation.subsets.all)};
  if (content.compare_with_paper) {
    // The paper compensates what the active double encoders leave, and judges at P_wrist.
    const bool comparable = at_wrist && campaign.campaign.double_encoder == DoubleEncoder::active;
    row.emplace_back(comparable ? percent(kPaperCompensated[static_cast<std::size_t>(method)], 0) : "–");
  }
  return row;
}

Table shareTable(const ReportContent& content, const ReportCampaign& one) {
  Table table{"Share of the deflection compensated",
              {"At", "Method", "All postures: fitted and judged", "Subsets: used", "Subsets: held out",
               "Subsets: all"},
              {}};
  table.id = "compensation";
  if (content.compare_with_paper) table.columns.emplace_back("Paper: all");
  for (const bool at_wrist : {true, false}) {
    RowGroup group{at_wrist ? "P_{wrist}" : "Reflectors", {}};
    for (const Method method : kMethods) {
      const MethodResult& result = one.identification.of(method);
      if (result.available && compensationAt(result, at_wrist)) {
        group.rows.push_back(shareRow(content, one, method, at_wrist));
      }
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

std::string noiseWords(const ReportCampaign& one) {
  const Identification& result = one.identification;
  if (!result.noise) {
    return fmt::format("What noise alone forbids is not known: {}.",
                       one.campaign.tracker
                           ? "the campaign has displacements only, not the readings they come from"
                           : "the tracker's noise is not declared");
  }
  const std::string at_targets = percent(result.noise->at_targets);
  if (!result.noise->at_wrist) {
    return fmt::format(
        "Noise of the tracker alone forbids about {} at the reflectors: no model can take that away.", at_targets);
  }
  return fmt::format(
      "Noise of the tracker alone forbids about {} at P_{{wrist}} and {} at the reflectors: no model can take that "
      "away.",
      percent(*result.noise->at_wrist), at_targets);
}

void writeAvoided(Html& html, const ReportContent& content) {
  std::string words;
  if (!content.avoided) return;  // the two states were not both measured: there is nothing to explain
  if (content.avoided->available) {
    words = fmt::format(
        "With the double encoders active the deflection at {} is smaller than with them inactive by {}, over {} "
        "postures at the same joint angles under the same load; the interval is of what other postures would give.",
        pointOf(*content.avoided), shareWords(*content.avoided), content.avoided->postures.size());
    if (content.compare_with_paper) words += fmt::format(" The paper: {}.", percent(kPaperAvoided, 0));
  } else {
    words = fmt::format("Not known: {}.", content.avoided->reason);
  }
  html.leaf("h3", "Avoided by the double encoders");
  html.paragraph(words);
}

}  // namespace

void writeCompensation(Html& html, const ReportContent& content) {
  const auto section = html.element("section", {{"id", "compensation"}});
  html.leaf("h2", "Deflection compensated and avoided");
  html.paragraph(
      "Compensated is 1 − Σ|what is left| / Σ|displacement|. Over the subsets of postures it is "
      "the mean: on the postures a subset used, on those it held out, and on all. P_{wrist} sees "
      "joints 1 to 3 only, the reflectors all six.");
  writeAvoided(html, content);
  writeEach(html, content, "compensation", [&](const ReportCampaign& one) {
    if (!shownMethod(one.identification)) {
      html.paragraph("No method is available, so nothing is compensated.");
      return;
    }
    writeTable(html, shareTable(content, one));
    if (one.identification.wrist_displacement.empty()) {
      html.paragraph("P_{wrist} is not measured in the load states: shares are given at the reflectors.");
    }
    html.paragraph(noiseWords(one));
  });
}

}  // namespace stiffscope::page
