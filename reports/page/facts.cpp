#include "reports/page/facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <set>
#include <variant>

#include "core/io/units.h"
#include "core/robot/balancer.h"
#include "reports/page/sections.h"
#include "reports/words/names.h"
#include "reports/words/numbers.h"

namespace stiffscope::page {

std::vector<Fact> sideBySide(const std::vector<Facts>& by_campaign) {
  std::vector<Fact> facts;
  for (std::size_t i = 0; i < by_campaign.size(); ++i) {
    for (const auto& said : by_campaign[i]) {
      const std::string& name = said.first;
      auto found = std::find_if(facts.begin(), facts.end(), [&](const Fact& fact) { return fact.name == name; });
      if (found == facts.end()) found = facts.insert(facts.end(), {name, std::vector<std::string>(by_campaign.size())});
      found->of[i] = said.second;
    }
  }
  return facts;
}

void writeFacts(Html& html, const std::string& caption, const std::vector<std::string>& names,
                const std::vector<Fact>& facts) {
  if (facts.empty()) return;
  const auto scroll = html.element(
      "div",
      {{"class", "scroll of-facts"}, {"role", "region"}, {"aria-label", reports::plain(caption)}, {"tabindex", "0"}});
  // Of few rows, in words of one day, it stays whole on paper.
  constexpr std::size_t kFew = 5;
  const bool whole = facts.size() <= kFew && names.size() <= 1;
  const auto table = html.element("table", {{"class", whole ? "words facts" : "words facts long"}});
  html.leaf("caption", caption);
  if (names.size() > 1) {
    const auto head = html.element("thead");
    const auto line = html.element("tr");
    html.leaf("th", "What", {{"scope", "col"}});
    for (const std::string& name : names) html.leaf("th", name, {{"scope", "col"}});
  }
  const auto body = html.element("tbody");
  for (const Fact& fact : facts) {
    const auto line = html.element("tr");
    html.leaf("th", fact.name, {{"scope", "row"}});
    const bool same =
        std::all_of(fact.of.begin(), fact.of.end(), [&](const auto& words) { return words == fact.of.front(); });
    if (same && fact.of.size() > 1) {
      html.leaf("td", fact.of.front(), {{"colspan", std::to_string(fact.of.size())}});
      continue;
    }
    for (const std::string& words : fact.of) html.leaf("td", words.empty() ? "–" : words);
  }
}

std::vector<std::string> columnNames(const reports::ReportContent& content) {
  std::vector<std::string> names;
  std::set<std::string> states;
  for (const reports::ReportCampaign& one : content.campaigns)
    states.insert(reports::encoderWords(one.campaign.double_encoder));
  const bool told_apart = states.size() == content.campaigns.size() && !states.contains("");
  for (const reports::ReportCampaign& one : content.campaigns)
    names.push_back(told_apart ? reports::capitalised(reports::encoderWords(one.campaign.double_encoder))
                               : reports::asIs(one.campaign.name));
  return names;
}

namespace {

/// What a campaign says of an instrument, "not stated" where it does not.
std::string instrument(const std::string& model, const std::string& serial, const std::string& certificate) {
  std::string words = reports::asIs(model.empty() ? std::string("model not stated") : model);
  words += serial.empty() ? "" : fmt::format(", serial number {}", reports::asIs(serial));
  return words + (certificate.empty() ? "; certificate not stated"
                                      : fmt::format("; certificate {}", reports::asIs(certificate)));
}

/// Their state and their joints: as the campaign states them, else those of which the readings have both sides.
std::string encoderFact(const reports::ReportCampaign& one) {
  if (!one.campaign.double_encoder_joints.empty()) return reports::encoderWordsOf(one.campaign);
  const std::string state = reports::encoderState(one.campaign.double_encoder);
  std::vector<std::string> joints;
  if (one.identification.transmission) {
    const auto& gears = one.identification.transmission->joints;
    for (std::size_t j = 0; j < gears.size(); ++j) {
      if (gears[j].postures > 0) joints.push_back(std::to_string(j + 1));
    }
  }
  if (!joints.empty())
    return fmt::format("{}; both sides of the gear read on joint{} {}", state, joints.size() > 1 ? "s" : "",
                       fmt::join(joints, ", "));
  if (one.campaign.double_encoder == campaign::DoubleEncoder::unspecified) return state;
  return state + "; on which joints is not stated";
}

/// "gas cylinder between bodies 1 and 2, pulls with 25.5 kN at 773 mm"; empty without one.
std::string balancersFact(const robot::Robot& robot) {
  std::vector<std::string> all;
  for (const robot::Balancer& balancer : robot.balancers) {
    const double length = robot::statedLength(balancer);
    const double force = robot::tensionAt(balancer, length).force_n;
    const bool gas = std::holds_alternative<robot::GasLaw>(balancer.law);
    all.push_back(fmt::format("{} between bodies {} and {}, {} with {} at {:.0f} mm", gas ? "gas cylinder" : "spring",
                              balancer.from.body, balancer.to.body, force < 0.0 ? "pushes" : "pulls",
                              reports::forceWords(std::abs(force)), length / io::kMillimetre));
  }
  return fmt::format("{}", fmt::join(all, "; "));
}

}  // namespace

Facts whoAndWhat(const reports::ReportCampaign& one) {
  const campaign::Campaign& campaign = one.campaign;
  const campaign::CampaignTexts& texts = campaign.texts;
  Facts facts;
  const auto add = [&facts](const char* name, const std::string& words) {
    if (!words.empty()) facts.emplace_back(name, words);
  };
  const auto own = [&add](const char* name, const std::string& words) {
    if (!words.empty()) add(name, reports::asIs(words));
  };
  own("Campaign", campaign.name);
  own("Measured on", campaign.date);
  own("Machine", campaign.robot.name);
  add("Balancers", balancersFact(campaign.robot));
  own("Serial number", texts.robot_serial);
  own("Controller", texts.controller);
  own("Item", texts.item);
  if (isLoaded(one)) add("Double encoders", encoderFact(one));
  own("Customer", texts.customer);
  own("Laboratory", texts.laboratory);
  own("Place", texts.place);
  own("Operator", texts.operator_name);
  if (texts.laboratory.empty() && texts.operator_name.empty()) add("Measured by", "not stated");
  own("Approved by", texts.approved_by);
  own("Date of issue", texts.date_of_issue);
  own("Environment", texts.environment);
  own("Conditions", texts.conditions);
  add("Tracker", campaign.tracker ? instrument(campaign.tracker->model, texts.tracker_serial, texts.tracker_certificate)
                                  : "not declared: no noise is known");
  if (campaign.load_cell)
    add("Load cell", texts.load_cell_certificate.empty()
                         ? "certificate not stated"
                         : fmt::format("certificate {}", reports::asIs(texts.load_cell_certificate)));
  if (!one.identification.cases.empty())
    add("Load",
        fmt::format("{} in {} postures (load step {})", reports::forceWords(reports::meanForce(one.identification)),
                    one.identification.cases.size(), one.identification.step));
  return facts;
}

}  // namespace stiffscope::page
