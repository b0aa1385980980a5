#include "reports/page/verdict.h"

#include <fmt/format.h>

#include <algorithm>

#include "reports/page/effect_words.h"
#include "reports/page/rich_text.h"
#include "reports/page/names.h"
#include "reports/page/numbers.h"

namespace stiffscope {

namespace {

/// What the shown method finds, or why there is none.
std::string jointsSentence(const Identification& identification) {
  const auto shown = page::shownMethod(identification);
  if (!shown) {
    return fmt::format("no joint stiffness can be identified: {}.",
                       identification.of(Method::partial_pose).reason);
  }
  const StiffnessEstimate& estimate = identification.of(*shown).estimate;
  std::vector<std::string> unseen, doubtful;
  for (int joint = 0; joint < 6; ++joint) {
    const bool seen = estimate.identifiable[static_cast<std::size_t>(joint)];
    if (!seen) unseen.push_back(page::jointName(joint));
    if (seen && !estimate.mark(joint).empty()) doubtful.push_back(page::jointName(joint));
  }
  std::string text =
      fmt::format("{} finds the stiffness of {} of 6 joints", page::longName(*shown), 6 - unseen.size());
  if (!unseen.empty()) {
    text += fmt::format(
        "; {} cannot be seen{}", fmt::join(unseen, ", "),
        identification.identifiability.load_hangs ? " under a load that only hangs" : " in this data");
  }
  if (!doubtful.empty()) {
    text += fmt::format("; {} {} not to be trusted", fmt::join(doubtful, ", "), doubtful.size() == 1 ? "is" : "are");
  }
  return text + ".";
}

/// "92 % of the deflection at P_{wrist} in postures it has not seen"; empty without a method.
std::string compensatedWords(const ReportCampaign& one) {
  const auto shown = page::shownMethod(one.identification);
  const page::JudgedPoint point = page::judgedPoint(one);
  if (!shown || !page::compensationAt(one.identification.of(*shown), point.at_wrist)) return {};
  const MethodResult& method = one.identification.of(*shown);
  if (const auto held_out = page::heldOut(method, point.at_wrist)) {
    return fmt::format("{} of the deflection at {} in postures it has not seen", page::percent(*held_out, 0),
                       point.name);
  }
  return fmt::format("{} of the deflection at {} in the postures it was fitted to, too few to hold some out",
                     page::percent(page::compensationAt(method, point.at_wrist)->all_postures, 0),
                     point.name);
}

/// What tells the campaigns of a report apart: the state of the double encoders, else the name.
std::string labelOf(const ReportCampaign& one) {
  const std::string state = page::encoderWords(one.campaign.double_encoder);
  return state.empty() ? fmt::format("in {}", page::asIs(one.campaign.name)) : fmt::format("with {}", state);
}

bool sameJoints(const std::vector<ReportCampaign>& campaigns) {
  return std::all_of(campaigns.begin(), campaigns.end(), [&](const ReportCampaign& one) {
    return jointsSentence(one.identification) == jointsSentence(campaigns.front().identification);
  });
}

/// Said once where it is the same in all campaigns.
std::string together(const std::vector<ReportCampaign>& campaigns) {
  std::string text = page::capitalised(jointsSentence(campaigns.front().identification));
  std::vector<std::string> shares;
  for (const ReportCampaign& one : campaigns) {
    const std::string words = compensatedWords(one);
    if (words.empty()) continue;
    const std::string label = campaigns.size() > 1 ? fmt::format("{} ", labelOf(one)) : std::string();
    shares.push_back(fmt::format("{}it takes away {}", label, words));
  }
  if (!shares.empty()) text += fmt::format(" {}.", page::capitalised(fmt::format("{}", fmt::join(shares, "; "))));
  return text;
}

std::string oneByOne(const std::vector<ReportCampaign>& campaigns) {
  std::string text;
  for (const ReportCampaign& one : campaigns) {
    text += fmt::format("{}{}, {}", text.empty() ? "" : " ", page::capitalised(labelOf(one)),
                        jointsSentence(one.identification));
    const std::string words = compensatedWords(one);
    if (!words.empty()) text += fmt::format(" It takes away {}.", words);
  }
  return text;
}

/// What is there besides joint springs; empty without a diagnosis.
std::string gapSentence(const ReportCampaign& one) {
  if (one.diagnosis == nullptr || !one.diagnosis->usable) return {};
  if (one.diagnosis->verdict.entries.empty()) return "What joint springs leave is noise, or too small to matter.";
  return page::asIs(fmt::format("Besides joint springs the readings show {} (see What the model misses).",
                                page::presentWords(one.diagnosis->verdict)));
}

/// Said once where it is the same in all campaigns.
std::string gapSentences(const std::vector<ReportCampaign>& campaigns) {
  const std::string first = gapSentence(campaigns.front());
  const bool same = std::all_of(campaigns.begin(), campaigns.end(),
                                [&](const ReportCampaign& one) { return gapSentence(one) == first; });
  if (same) return first.empty() ? first : " " + first;
  std::string text;
  for (const ReportCampaign& one : campaigns) {
    const std::string words = gapSentence(one);
    if (!words.empty()) text += fmt::format(" {}: {}", page::capitalised(labelOf(one)), words);
  }
  return text;
}

}  // namespace

std::string verdictOf(const std::vector<ReportCampaign>& campaigns,
                      const std::optional<AvoidedByEncoders>& avoided) {
  if (campaigns.empty()) return {};
  std::string text = sameJoints(campaigns) ? together(campaigns) : oneByOne(campaigns);
  if (avoided && avoided->available) {
    text += fmt::format(" The double encoders avoid {} of the deflection at {}.",
                        page::percent(avoided->share, 0), pointOf(*avoided));
  }
  text += gapSentences(campaigns);
  return text;
}

}  // namespace stiffscope
