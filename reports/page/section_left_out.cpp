#include <fmt/format.h>

#include "reports/page/sections.h"

namespace stiffscope::page {

namespace {

/// Postures and parameters; joints, methods and the wrist centre say so where their numbers would stand.
std::vector<std::string> leftOut(const Identification& result) {
  std::vector<std::string> items = result.left_out;
  if (!result.calibration.fixed.empty()) {
    items.push_back(fmt::format("PP's geometry, kept at its start because the positions do not see it: {}.",
                                fmt::join(result.calibration.fixed, ", ")));
  }
  return items;
}

}  // namespace

void writeLeftOut(Html& html, const ReportContent& content) {
  writeForEach(html, content, "left-out", "What was left out, and why", [&](const ReportCampaign& one) {
    const std::vector<std::string> items = leftOut(one.identification);
    if (one.identification.left_out.empty()) html.paragraph("No posture was left out.");
    html.list(items);
  });
}

}  // namespace stiffscope::page
