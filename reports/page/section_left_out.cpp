#include <fmt/format.h>

#include "reports/page/names.h"
#include "reports/page/sections.h"

namespace stiffscope::page {

namespace {

std::vector<std::string> leftOut(const Identification& result) {
  std::vector<std::string> items = result.left_out;
  for (const Method method : kMethods) {
    if (!result.of(method).available)
      items.push_back(fmt::format("{}: {}.", longName(method), result.of(method).reason));
  }
  for (int joint = 0; joint < 6; ++joint) {
    const JointIdentifiability& one = result.identifiability.joints[static_cast<std::size_t>(joint)];
    if (!one.identifiable && !one.reason.empty())
      items.push_back(fmt::format("{}: {}.", jointName(joint), one.reason));
  }
  if (!result.frames.wrist.measured)
    items.push_back(fmt::format("Wrist centre: {}.", result.frames.wrist.reason));
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
    if (items.empty()) html.paragraph("Nothing: every posture, joint and method is in.");
    html.list(items);
  });
}

}  // namespace stiffscope::page
