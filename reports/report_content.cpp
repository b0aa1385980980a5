#include "reports/report_content.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "core/comparison/matched_postures.h"
#include "core/io/read_file.h"
#include "reports/words/numbers.h"

namespace stiffscope::reports {

namespace {

const ReportCampaign* firstWith(const std::vector<ReportCampaign>& campaigns, campaign::DoubleEncoder state) {
  const auto found = std::find_if(campaigns.begin(), campaigns.end(),
                                  [state](const ReportCampaign& one) { return one.campaign.double_encoder == state; });
  return found == campaigns.end() ? nullptr : &*found;
}

/// By joint springs alone: what both states miss cancels in what is compared.
const identification::Identification& springsOf(const ReportCampaign& one) {
  return one.improved != nullptr ? one.improved->without : one.identification;
}

void addJoints(const ReportCampaign& inactive, const ReportCampaign& active, const comparison::MatchedPostures& matched,
               AvoidedByEncoders& avoided) {
  using identification::Method;
  const identification::Identification &before = springsOf(inactive), &after = springsOf(active);
  const comparison::SupportedModels models = supportedModels(inactive.improved, active.improved);
  std::array<comparison::StiffnessChange, 3> methods;
  for (const Method method : identification::kMethods) {
    methods[static_cast<std::size_t>(method)] =
        comparison::compareStiffness(inactive.campaign, before, active.campaign, after, method, matched, models);
  }
  const auto first = comparison::comparedFirst(before, after, methods);
  avoided.method = first ? first->method : Method::complete_pose;
  avoided.by_joint = methods[static_cast<std::size_t>(avoided.method)];
  avoided.residual_is_noise =
      (models.effects && models.explained) ||
      comparison::commonResidual(inactive.campaign, before, active.campaign, after, matched).isNoise();
}

}  // namespace

DayKind kindOf(const ReportCampaign& one) {
  if (one.accuracy != nullptr) return DayKind::unloaded;
  const campaign::Campaign& campaign = one.campaign;
  // A load cell that is declared and was not read makes no loaded day.
  const bool states = campaign.loading || campaign.displacements || campaign.states;
  const bool sweeps = campaign.circle_sweeps || campaign.wrist_sweep;
  return one.identification.cases.empty() && sweeps && !states ? DayKind::sweeps : DayKind::loaded;
}

bool anyOfKind(const std::vector<ReportCampaign>& campaigns, DayKind kind) {
  return std::any_of(campaigns.begin(), campaigns.end(),
                     [kind](const ReportCampaign& one) { return kindOf(one) == kind; });
}

std::vector<ReportCampaign> ofKind(const std::vector<ReportCampaign>& campaigns, DayKind kind) {
  std::vector<ReportCampaign> some;
  for (const ReportCampaign& one : campaigns) {
    if (kindOf(one) == kind) some.push_back(one);
  }
  return some;
}

int mostJointsOf(const std::vector<ReportCampaign>& campaigns) {
  int most = 0;
  for (const ReportCampaign& one : campaigns) most = std::max(most, one.campaign.robot.joints());
  return most;
}

comparison::SupportedModels supportedModels(const extended_model::ExtendedModel* before,
                                            const extended_model::ExtendedModel* after) {
  if (before == nullptr || after == nullptr) return {};
  const auto explained = [](const extended_model::ExtendedModel& model) {
    return !model.hidden || !model.hidden->unexplained;
  };
  return {&before->with, &after->with, !before->effects.added.empty() || !after->effects.added.empty(),
          explained(*before) && explained(*after)};
}

std::optional<AvoidedByEncoders> avoidedByEncoders(const std::vector<ReportCampaign>& campaigns) {
  const ReportCampaign* inactive = firstWith(campaigns, campaign::DoubleEncoder::inactive);
  const ReportCampaign* active = firstWith(campaigns, campaign::DoubleEncoder::active);
  if (inactive == nullptr || active == nullptr) return std::nullopt;
  AvoidedByEncoders avoided;
  avoided.reason = comparison::differenceOfMachines(inactive->campaign.robot, active->campaign.robot);
  if (!avoided.reason.empty()) return avoided;
  const identification::Identification &before = springsOf(*inactive), &after = springsOf(*active);
  const comparison::MatchedPostures matched =
      comparison::matchPostures(inactive->campaign, before, active->campaign, after);
  static_cast<comparison::DeflectionAvoided&>(avoided) = comparison::deflectionAvoidedAtWrist(before, after, matched);
  avoided.at_wrist = avoided.available;
  if (!avoided.available)
    static_cast<comparison::DeflectionAvoided&>(avoided) =
        comparison::deflectionAvoidedAtTargets(before, after, matched);
  addJoints(*inactive, *active, matched, avoided);
  return avoided;
}

std::string pointOf(const AvoidedByEncoders& avoided) { return avoided.at_wrist ? "P_{wrist}" : "the reflectors"; }

std::string shareWords(const AvoidedByEncoders& avoided) {
  const std::string share = percent(avoided.share);
  if (!std::isfinite(avoided.low)) return share;
  return fmt::format("{} (95\u00a0%: {} to {})", share, fixed(100.0 * avoided.low, 1), percent(avoided.high));
}

std::string reportId(const ReportContent& content) {
  std::string all = content.compare_with_paper ? "paper\n" : "\n";
  // Lengths keep apart what would read the same run together.
  const auto add = [&all](const std::string& text) { all += fmt::format("{}:{}\n", text.size(), text); };
  for (const ReportCampaign& one : content.campaigns) {
    add(one.campaign.name);
    add(one.campaign.date);
    for (const campaign::InputFile& file : one.campaign.inputs) {
      add(file.name);
      add(file.sha256);
    }
  }
  for (const NamedText& setting : content.settings) {
    add(setting.name);
    add(setting.text);
  }
  if (!content.versions.empty()) add(content.versions.front().text);
  const std::string hex = io::sha256Hex(all);
  return fmt::format("{}-{}-{}", hex.substr(0, 4), hex.substr(4, 4), hex.substr(8, 4));
}

}  // namespace stiffscope::reports
