#include "reports/page/verdict.h"

#include <fmt/format.h>

#include "reports/page/names.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

std::string jointsSentence(const Identification& identification, const MethodResult& method,
                           const char* name) {
  std::vector<std::string> unseen, doubtful;
  for (int joint = 0; joint < 6; ++joint) {
    const bool seen = method.estimate.identifiable[static_cast<std::size_t>(joint)];
    if (!seen) unseen.push_back(page::jointName(joint));
    if (seen && !method.estimate.mark(joint).empty()) doubtful.push_back(page::jointName(joint));
  }
  std::string text = fmt::format("{} finds the stiffness of {} of 6 joints", name, 6 - unseen.size());
  if (!unseen.empty()) {
    text += fmt::format(
        "; {} cannot be seen{}", fmt::join(unseen, ", "),
        identification.identifiability.load_hangs ? " under a load that only hangs" : " in this data");
  }
  if (!doubtful.empty()) text += fmt::format("; {} is not to be trusted", fmt::join(doubtful, ", "));
  return text + ".";
}

std::string compensationSentence(const ReportCampaign& one, const MethodResult& method) {
  const page::JudgedPoint point = page::judgedPoint(one);
  const auto& compensation = page::compensationAt(method, point.at_wrist);
  if (!compensation) return {};
  if (const auto held_out = page::heldOut(method, point.at_wrist)) {
    return fmt::format(" It takes away {} of the deflection at {} in postures it has not seen.",
                       page::percent(*held_out, 0), point.name);
  }
  return fmt::format(
      " It takes away {} of the deflection at {} in the postures it was fitted to; there are too few to "
      "hold some out.",
      page::percent(compensation->all_postures, 0), point.name);
}

std::string verdictOf(const ReportCampaign& one) {
  const auto shown = page::shownMethod(one.identification);
  if (!shown) {
    return fmt::format("No joint stiffness can be identified: {}.",
                       one.identification.of(Method::partial_pose).reason);
  }
  const MethodResult& method = one.identification.of(*shown);
  return jointsSentence(one.identification, method, page::longName(*shown).c_str()) +
         compensationSentence(one, method);
}

}  // namespace

std::string verdictOf(const std::vector<ReportCampaign>& campaigns,
                      const std::optional<AvoidedShare>& avoided) {
  std::string text;
  for (const ReportCampaign& one : campaigns) {
    if (!text.empty()) text += ' ';
    if (campaigns.size() > 1) text += fmt::format("{}: ", one.campaign.name);
    text += verdictOf(one);
  }
  if (avoided) {
    text += fmt::format(" The double encoders avoid {} of the deflection at {}.",
                        page::percent(avoided->share, 0), avoided->point);
  }
  return text;
}

}  // namespace stiffscope
