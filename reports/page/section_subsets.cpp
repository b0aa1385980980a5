#include <fmt/format.h>

#include "core/identification/stiffness_spread.h"
#include "reports/page/html_table.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"
#include "reports/page/paper_values.h"
#include "reports/page/sections.h"

namespace stiffscope::page {

namespace {


Row spreadRow(const ReportContent& content, const ReportCampaign& one, Method method, int joint) {
  const StiffnessSpread spread = spreadOf(one.identification.of(method).subsets, joint);
  const double width = (spread.high - spread.low) / kMega;
  Row row{shortName(method), withUncertainty(spread.mean / kMega, spread.sd / kMega),
          toPlaceOf(spread.median / kMega, width),
          fmt::format("{} to {}", toPlaceOf(spread.low / kMega, width), toPlaceOf(spread.high / kMega, width)),
          percent(spread.share_negative)};
  if (content.compare_with_paper) {
    const auto paper = paperStiffness(one.campaign.double_encoder, method, joint);
    row.emplace_back(paper ? fmt::format("{} & {}", asPrinted(paper->mean), asPrinted(paper->sd)) : "–");
  }
  return row;
}

Table tableTwo(const ReportContent& content, const ReportCampaign& one, const SubsetStudy& any) {
  Table table{fmt::format("Table II: joint stiffness over {}, 10⁶\u00a0Nm/rad", subsetWords(any)),
              {"Joint", "Method", "Mean ± sd", "Median", "5 to 95\u00a0%", "Negative"},
              {}};
  table.id = "subsets";
  if (content.compare_with_paper) table.columns.emplace_back("Paper, mean & sd");
  for (int joint = 0; joint < 6; ++joint) {
    RowGroup group{jointName(joint), {}};
    for (const Method method : kMethods) {
      const MethodResult& result = one.identification.of(method);
      const bool there = result.available && result.estimate.identifiable[static_cast<std::size_t>(joint)] &&
                         !result.subsets.compliances.empty();
      if (there) group.rows.push_back(spreadRow(content, one, method, joint));
    }
    table.groups.push_back(std::move(group));
  }
  return table;
}

}  // namespace

void writeSubsets(Html& html, const ReportContent& content) {
  writeForEach(html, content, "subsets", "Spread over subsets of postures", [&](const ReportCampaign& one) {
    const auto shown = shownMethod(one.identification);
    if (!shown) {
      html.paragraph("No method is available, so there is no spread to show.");
      return;
    }
    const SubsetStudy& study = one.identification.of(*shown).subsets;
    if (study.compliances.empty()) {
      html.paragraph(
          fmt::format("{} postures are too few to draw subsets from.", one.identification.cases.size()));
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
