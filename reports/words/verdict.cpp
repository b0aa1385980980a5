#include "reports/words/verdict.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "core/comparison/matched_postures.h"
#include "reports/words/accuracy_words.h"
#include "reports/words/day_words.h"
#include "reports/words/effect_words.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/rich_text.h"

namespace stiffscope::reports {

std::vector<std::string> doubtsOfTheMachine(const std::vector<ReportCampaign>& campaigns) {
  std::vector<std::string> sentences;
  for (std::size_t i = 1; i < campaigns.size(); ++i) {
    const campaign::Campaign &first = campaigns.front().campaign, &other = campaigns[i].campaign;
    std::vector<Remark> doubts{comparison::differenceOfMachines(first.robot, other.robot)};
    if (doubts.front().empty()) doubts = comparison::doubtsOfOneMachine(first.robot, other.robot);
    for (const std::string& doubt : words(doubts))
      sentences.push_back(fmt::format("{} and {}: {}", first.name, other.name, doubt));
  }
  return sentences;
}

std::string negativeFitWords(const identification::Identification& identification) {
  const auto shown = shownMethod(identification);
  if (!shown) return {};
  const identification::StiffnessEstimate& estimate = identification.of(*shown).estimate;
  bool any = false;
  for (int joint = 0; joint < estimate.joints(); ++joint) {
    if (!estimate.identifiable[static_cast<std::size_t>(joint)]) continue;
    if (estimate.compliance[joint] >= 0.0) return {};
    any = true;
  }
  if (!any) return {};
  return fmt::format("every stiffness by {} is negative, so no share of the deflection counts as compensated",
                     shortName(*shown));
}

namespace {

/// What the shown method finds, or why there is none.
std::string jointsSentence(const identification::Identification& identification) {
  const auto shown = shownMethod(identification);
  if (!shown) {
    return fmt::format("no joint stiffness can be identified: {}.",
                       words(identification.of(identification::Method::partial_pose).reason));
  }
  const identification::StiffnessEstimate& estimate = identification.of(*shown).estimate;
  std::vector<std::string> unseen, doubtful;
  for (int joint = 0; joint < estimate.joints(); ++joint) {
    const bool seen = estimate.identifiable[static_cast<std::size_t>(joint)];
    if (!seen) unseen.push_back(jointName(joint));
    if (seen && !estimate.mark(joint).empty()) doubtful.push_back(jointName(joint));
  }
  // As the first page's card counts them: not those that are not to be trusted.
  std::string text = fmt::format("{} finds the stiffness of {} of {} joints", longName(*shown),
                                 estimate.identifiable.size() - unseen.size() - doubtful.size(), estimate.joints());
  if (!unseen.empty()) {
    text += fmt::format("; {} cannot be seen{}", fmt::join(unseen, ", "),
                        identification.identifiability.load_hangs ? " under a load that only hangs" : " in this data");
  }
  if (!doubtful.empty()) {
    text += fmt::format("; {} {} not to be trusted", fmt::join(doubtful, ", "), doubtful.size() == 1 ? "is" : "are");
  }
  if (const std::string negative = negativeFitWords(identification); !negative.empty()) text += "; " + negative;
  return text + ".";
}

/// "92 % of the deflection at the reflectors and 88 % at P_{wrist} in postures it has not seen"; empty without a
/// method, and where it finds negative stiffnesses alone.
std::string compensatedWords(const ReportCampaign& one) {
  const auto shown = shownMethod(one.identification);
  if (!negativeFitWords(one.identification).empty()) return {};
  if (!shown || !compensationAt(one.identification.of(*shown), false)) return {};
  const identification::MethodResult& method = one.identification.of(*shown);
  const auto held_out = heldOut(method, false);
  const auto share = [&](bool at_wrist) {
    return percent(held_out ? *heldOut(method, at_wrist) : compensationAt(method, at_wrist)->all_postures, 0);
  };
  std::string text = fmt::format("{} of the deflection at the reflectors", share(false));
  if (compensationAt(method, true)) text += fmt::format(" and {} at P_{{wrist}}", share(true));
  return text +
         (held_out ? " in postures it has not seen" : " in the postures it was fitted to, too few to hold some out");
}

/// What tells the campaigns of a report apart: the state of the double encoders, else the name.
std::string labelOf(const ReportCampaign& one) {
  const std::string state = encoderWords(one.campaign.double_encoder);
  return state.empty() ? fmt::format("in {}", asIs(one.campaign.name)) : fmt::format("with {}", state);
}

bool sameJoints(const std::vector<ReportCampaign>& campaigns) {
  return std::all_of(campaigns.begin(), campaigns.end(), [&](const ReportCampaign& one) {
    return jointsSentence(one.identification) == jointsSentence(campaigns.front().identification);
  });
}

/// What is the same in all campaigns once, then what each takes away.
std::vector<std::string> together(const std::vector<ReportCampaign>& campaigns) {
  std::vector<std::string> items{capitalised(jointsSentence(campaigns.front().identification))};
  for (const ReportCampaign& one : campaigns) {
    const std::string words = compensatedWords(one);
    if (words.empty()) continue;
    const std::string label = campaigns.size() > 1 ? fmt::format("{} ", labelOf(one)) : std::string();
    items.push_back(capitalised(fmt::format("{}it takes away {}.", label, words)));
  }
  return items;
}

std::vector<std::string> oneByOne(const std::vector<ReportCampaign>& campaigns) {
  std::vector<std::string> items;
  for (const ReportCampaign& one : campaigns) {
    items.push_back(fmt::format("{}, {}", capitalised(labelOf(one)), jointsSentence(one.identification)));
    const std::string words = compensatedWords(one);
    if (!words.empty()) items.back() += fmt::format(" It takes away {}.", words);
  }
  return items;
}

/// What is there besides joint springs; empty without a diagnosis.
std::string gapSentence(const ReportCampaign& one) {
  if (one.diagnosis == nullptr || !one.diagnosis->usable) return {};
  if (one.diagnosis->verdict.entries.empty()) return "What joint springs leave is noise, or too small to matter.";
  return fmt::format("{} (see @{{What the model misses}}).",
                     asIs("Besides joint springs the readings show " + presentWords(one.diagnosis->verdict)));
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
    if (!words.empty()) text += fmt::format(" {}: {}", capitalised(labelOf(one)), words);
  }
  return text;
}

}  // namespace

std::string changedWithoutEncoder(const std::vector<ReportCampaign>& campaigns, const AvoidedByEncoders& avoided) {
  if (!avoided.by_joint.available) return {};
  constexpr double kLevel = 0.05, kLeast = 0.01;  // of all joints together; of the stiffness: less is no news
  const std::vector<int>& having = campaigns.front().campaign.double_encoder_joints;
  if (having.empty()) return {};
  std::vector<std::string> changes;
  for (std::size_t j = 0; j < avoided.by_joint.joints.size(); ++j) {
    const comparison::JointChange& joint = avoided.by_joint.joints[j];
    const double change = joint.ratio.value - 1.0;
    const bool held = std::find(having.begin(), having.end(), static_cast<int>(j)) != having.end();
    if (held || !joint.comparable || !(joint.p_holm < kLevel) || !(std::abs(change) > kLeast)) continue;
    changes.push_back(fmt::format("{} by {}{}", jointName(static_cast<int>(j)), change > 0.0 ? "+" : "\u2212",
                                  percent(std::abs(change), 0)));
  }
  return fmt::format("{}", fmt::join(changes, ", "));
}

namespace {

/// Of the days with a load.
std::vector<std::string> stiffnessVerdict(const std::vector<ReportCampaign>& campaigns,
                                          const std::optional<AvoidedByEncoders>& avoided) {
  std::vector<std::string> items = sameJoints(campaigns) ? together(campaigns) : oneByOne(campaigns);
  if (!avoided || !avoided->available) return items;
  items.push_back(fmt::format("The double encoders avoid {} of the deflection at {}.", percent(avoided->share, 0),
                              pointOf(*avoided)));
  if (const std::string changes = changedWithoutEncoder(campaigns, *avoided); !changes.empty())
    items.back() += fmt::format(
        " Joints that have none differ as well ({}): not only the encoders changed between the two days.", changes);
  return items;
}

}  // namespace

std::string diagnosisVerdict(const std::vector<ReportCampaign>& campaigns) {
  const std::vector<ReportCampaign> loaded = ofKind(campaigns, DayKind::loaded);
  if (loaded.empty()) return {};
  const std::string text = gapSentences(loaded);
  return text.empty() ? text : text.substr(1);
}

std::vector<std::string> verdictItems(const std::vector<ReportCampaign>& campaigns,
                                      const std::optional<AvoidedByEncoders>& avoided) {
  std::vector<std::string> items;
  const auto named = [&](const ReportCampaign& one, const std::string& words) {
    return (campaigns.size() > 1 ? asIs(one.campaign.name) + ": " : std::string()) + words;
  };
  for (const ReportCampaign& one : ofKind(campaigns, DayKind::unloaded))
    items.push_back(named(one, accuracyVerdict(one)));
  if (const std::vector<ReportCampaign> loaded = ofKind(campaigns, DayKind::loaded); !loaded.empty()) {
    std::vector<std::string> own = stiffnessVerdict(loaded, avoided);
    if (loaded.size() == 1) own.front() = named(loaded.front(), own.front());
    items.insert(items.end(), own.begin(), own.end());
  }
  for (const ReportCampaign& one : ofKind(campaigns, DayKind::sweeps)) items.push_back(named(one, sweepsVerdict(one)));
  return items;
}

std::string verdictOf(const std::vector<ReportCampaign>& campaigns, const std::optional<AvoidedByEncoders>& avoided) {
  return fmt::format("{}", fmt::join(verdictItems(campaigns, avoided), " "));
}

}  // namespace stiffscope::reports
