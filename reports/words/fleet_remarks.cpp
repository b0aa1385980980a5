#include "core/fleet/remarks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>

#include "reports/words/fleet_words.h"
#include "reports/words/numbers.h"
#include "reports/words/remark_words.h"
#include "reports/words/remarks.h"
#include "reports/words/rich_text.h"

namespace stiffscope::reports {

namespace {

/// Ids as words: "base compliance or bearing tilt".
std::string idWords(const std::vector<std::string>& ids, const char* between) {
  std::string all = fmt::format("{}", fmt::join(ids, between));
  std::replace(all.begin(), all.end(), '_', ' ');
  return all;
}

std::string holmWords(double p) { return p < 1e-6 ? "p < 10⁻⁶" : fmt::format("p = {}", significant(p, 2)); }

}  // namespace

std::string effectsKey(const fleet::CampaignResult& result) {
  std::vector<std::string> entries;
  for (const fleet::EffectFound& one : result.effects)
    entries.push_back(fmt::format("{}", fmt::join(one.effects, "|")));
  return entries.empty() ? "none" : fmt::format("{}", fmt::join(entries, "+"));
}

int mostJointsOf(const fleet::Fleet& fleet) {
  int most = 0;
  for (const fleet::FleetCampaign& one : fleet.campaigns) {
    if (one.result) most = std::max(most, one.result->joints());
  }
  constexpr int kUsual = 6;
  return most > 0 ? most : kUsual;
}

namespace {

/// Of the arms of the same name that come first.
int armsOfName(const fleet::Fleet& fleet, const std::string& machine, std::size_t among) {
  return static_cast<int>(std::count_if(fleet.arms.begin(), fleet.arms.begin() + static_cast<std::ptrdiff_t>(among),
                                        [&](const fleet::Arm& one) { return one.machine == machine; }));
}

}  // namespace

int machineNumber(const fleet::Fleet& fleet, const fleet::DaySeries& series) {
  return 1 + armsOfName(fleet, series.machine, series.arm);
}

std::string machineWords(const fleet::Fleet& fleet, const fleet::DaySeries& series) {
  const int all = armsOfName(fleet, series.machine, fleet.arms.size());
  if (all < 2) return series.machine;
  return fmt::format("{} (machine {} of {})", series.machine, machineNumber(fleet, series), all);
}

std::string needName(fleet::NeedId id) {
  switch (id) {
    case fleet::NeedId::no_result:
      return "no result";
    case fleet::NeedId::several_machines:
      return "several machines";
    case fleet::NeedId::audit_failed:
      return "audit failed";
    case fleet::NeedId::changed:
      return "changed";
    case fleet::NeedId::unknown_gap:
      return "unknown gap";
    case fleet::NeedId::audit_not_testable:
      return "not testable";
    case fleet::NeedId::perhaps_changed:
      return "perhaps changed";
    case fleet::NeedId::dates_scatter:
      return "dates scatter";
    case fleet::NeedId::joint_imprecise:
      return "imprecise joint";
    case fleet::NeedId::audit_warned:
      return "audit warns";
    case fleet::NeedId::nothing:
      return "nothing";
  }
  return {};
}

std::string fleetWords(fleet::RemarkId id, const RemarkValues& values) {
  using enum fleet::RemarkId;
  switch (id) {
    case no_result:
      return fmt::format("{}: {}", values.name(0), values.name(1));
    case several_machines:
      return fmt::format("{} machines under one name, not compared with each other: of {} and {} {}", values.count(0),
                         asIs(values.name(1)), asIs(values.name(2)), words(values.remark(3)));
    case audit_failed:
      return fmt::format("{}: audit fails by {}", values.name(0), idWords(values.names(1), ", "));
    case audit_not_testable:
      return fmt::format("{}: checks that a pass needs could not be made", values.name(0));
    case effect_appeared:
      return fmt::format("{} from {} on, and on no date before", idWords(values.names(0), " or "), values.name(1));
    case effect_gone:
      return fmt::format("{} until before {}, and on no date since", idWords(values.names(0), " or "), values.name(1));
    case effect_once:
      return fmt::format("{} on {}, the last date, alone", idWords(values.names(0), " or "), values.name(1));
    case compliance_changed: {
      const double share = values.number(1);
      // Of a compliance that is not above its own U no share is known, only which way it went.
      const std::string size = std::isfinite(share) ? fmt::format("compliance {}{} ± {}", share > 0.0 ? "+" : "−",
                                                                  percent(std::abs(share)), percent(values.number(2)))
                                                    : std::string("share not known");
      return fmt::format("joint {} {} from {} on: {} ({} after Holm, {} date{} from then on)", values.count(0),
                         share > 0.0 ? "softer" : "stiffer", values.name(3), size, holmWords(values.number(4)),
                         values.count(5), values.count(5) == 1 ? "" : "s");
    }
    case geometry_changed:
      return fmt::format("geometry another from {} on: {} µm at the reflectors ({} after Holm)", values.name(0),
                         fixed(um(values.number(1)), 0), holmWords(values.number(2)));
    case unknown_gap:
      return fmt::format("{}: a gap that no known effect explains", values.name(0));
    case joint_imprecise: {
      const std::vector<std::int64_t>& joints = values.counts(0);
      return fmt::format("{}: interval open, or wider than the stiffness, of joint{} {}", values.name(1),
                         joints.size() == 1 ? "" : "s", fmt::join(joints, ", "));
    }
    case dates_scatter:
      return fmt::format("joint {}: dates scatter by {} times what is stated", values.count(0),
                         fixed(values.number(1), 1));
    case audit_warned:
      return fmt::format("{}: audit warns of {}", values.name(0), idWords(values.names(1), ", "));
    case mend_campaign:
      return "mend what the message names and run the fleet again: only this campaign is done anew";
    case tell_machines_apart:
      return "state each machine's robot_serial in campaign.xml, or keep its campaigns in a folder of its own, and of "
             "one machine the same URDF; then run the fleet again";
    case measure_again:
      return "mend what the audit names and measure again";
    case inspect_joint:
      return fmt::format("inspect joint {}: gear, bearing and their screws; then measure the same postures again",
                         values.count(0));
    case inspect_effect:
      return fmt::format("inspect for {}; then measure the same postures again", idWords(values.names(0), " or "));
    case confirm_change:
      return "measure the same postures once more: a change that stays is one";
    case follow_next_measurement:
      return "measure what this campaign's diagnosis asks for next";
    case repeat_same_postures:
      return "measure twice on one day in the same postures: this tells the machine's scatter from the set-up's";
    case calibrate_again:
      return "inspect for a collision or a loose foot; then calibrate anew";
    case nothing_to_do:
      return "nothing";
  }
  return {};
}

}  // namespace stiffscope::reports
