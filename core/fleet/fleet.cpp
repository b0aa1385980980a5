#include "core/fleet/fleet.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "core/fleet/remarks.h"

namespace stiffscope::fleet {

using identification::Method;

std::string machineOf(const std::string& robot_serial, const std::string& item, const std::string& folder) {
  if (!robot_serial.empty()) return robot_serial;
  if (!item.empty()) return item;
  // The same folder however it is named: from above, from within, or as `.`.
  std::filesystem::path path = std::filesystem::absolute(folder).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  const std::string above = path.parent_path().filename().string();
  return above.empty() ? path.filename().string() : above;
}

bool inOrder(const FleetCampaign& a, const FleetCampaign& b) {
  return std::tie(a.machine, a.date, a.folder) < std::tie(b.machine, b.date, b.folder);
}

void sortCampaigns(std::vector<FleetCampaign>& campaigns) { std::sort(campaigns.begin(), campaigns.end(), inOrder); }

namespace {

/// Corrects the pairs' p-values for their number; returns it.
std::size_t correctPairs(const std::vector<FleetCampaign>& campaigns, std::vector<FleetPair>& pairs) {
  std::vector<double> p_values;
  for (FleetPair& pair : pairs) {
    pair.p_holm.assign(static_cast<std::size_t>(campaigns[pair.after].result->joints()), kUnknown);
    for (std::size_t j = 0; j < pair.p_holm.size(); ++j)
      p_values.push_back(pair.result && j < pair.result->p_value.size() ? pair.result->p_value[j] : kUnknown);
    p_values.push_back(pair.result ? pair.result->machine_p : kUnknown);
  }
  const std::vector<double> corrected = comparison::holm(p_values);
  auto next = corrected.begin();
  for (FleetPair& pair : pairs) {
    for (double& p : pair.p_holm) p = *next++;
    pair.machine_p_holm = *next++;
  }
  return static_cast<std::size_t>(
      std::count_if(p_values.begin(), p_values.end(), [](double p) { return std::isfinite(p); }));
}

/// The method that most days show first of those that all have; empty without one.
std::optional<Method> commonMethod(const std::vector<const CampaignResult*>& days) {
  std::optional<Method> best;
  std::ptrdiff_t most = -1;
  for (const Method method : identification::kMethodsOfEquals) {
    const bool everywhere = std::all_of(days.begin(), days.end(), [method](const CampaignResult* day) {
      return day->springs[static_cast<std::size_t>(method)].available;
    });
    const auto shown = std::count_if(days.begin(), days.end(),
                                     [method](const CampaignResult* day) { return day->springs_method == method; });
    if (everywhere && shown > most) best = method, most = shown;
  }
  return best;
}

Stated statedOf(const comparison::Uncertain& number) {
  const double u = number.expanded();
  return {number.value, number.value - u, number.value + u};
}

/// Fills difference, share taken and p-value of each joint that both days see.
void compareCompliances(const CampaignResult& before, const CampaignResult& after, const ComplianceSeries& both,
                        PairResult& result) {
  for (int joint = 0; joint < after.joints(); ++joint) {
    if (!both.has(joint)) continue;
    const std::size_t j = static_cast<std::size_t>(joint);
    const comparison::Uncertain difference = both.contrast(joint, Eigen::Vector2d(-1.0, 1.0), {0, 1});
    result.difference[j] = statedOf(difference);
    result.p_value[j] = both.pOfNothing(difference);
    const auto complianceOn = [&](const CampaignResult& day) {
      return (result.method ? day.springs[static_cast<std::size_t>(*result.method)] : day.own_weight).compliance[joint];
    };
    const double c_before = complianceOn(before), c_after = complianceOn(after);
    comparison::Uncertain taken =
        both.contrast(joint, Eigen::Vector2d(c_after / (c_before * c_before), -1.0 / c_before), {0, 1});
    taken.value = 1.0 - c_after / c_before;
    if (c_before > 0.0) result.taken[j] = statedOf(taken);
  }
}

PairResult comparedLoaded(const CampaignResult& before, const CampaignResult& after) {
  PairResult result(after.joints());
  result.method = commonMethod({&before, &after});
  if (!result.method) return result;
  const ComplianceSeries both({&before, &after}, result.method);
  result.same_postures = both.samePostures();
  result.postures = static_cast<int>(both.posturesOfAll());
  compareCompliances(before, after, both, result);
  return result;
}

bool showsOwnWeight(const std::vector<const CampaignResult*>& days) {
  return std::all_of(days.begin(), days.end(), [](const CampaignResult* day) { return day->own_weight.available; });
}

/// A series whose compliances can be held against each other.
struct Charted {
  std::size_t series = 0;
  std::optional<Method> method;  ///< none: by own weight
  ComplianceSeries compliances;
  int joints = 0;
};

std::vector<Charted> chartedSeries(const Fleet& fleet) {
  std::vector<Charted> charted;
  for (std::size_t s = 0; s < fleet.series.size(); ++s) {
    std::vector<const CampaignResult*> days;
    for (const std::size_t one : fleet.series[s].campaigns) days.push_back(&*fleet.campaigns[one].result);
    const bool loaded = fleet.series[s].kind == DayKind::loaded;
    const auto method = loaded ? commonMethod(days) : std::nullopt;
    if (loaded ? method.has_value() : showsOwnWeight(days))
      charted.push_back({s, method, ComplianceSeries(days, method), fleet.series[s].joints});
  }
  return charted;
}

/// Whether a joint of a series has no step, or a pair's geometry no change, and the p-value of that.
struct Question {
  const Charted* charted = nullptr;
  int joint = 0;
  const FleetPair* pair = nullptr;
  double p_value = 1.0;
};

std::vector<Question> questionsOf(const std::vector<Charted>& charted, const std::vector<FleetPair>& pairs) {
  std::vector<Question> questions;
  for (const Charted& one : charted) {
    for (int joint = 0; joint < one.joints; ++joint) {
      if (one.compliances.days() < 2 || !one.compliances.has(joint)) continue;
      questions.push_back({&one, joint, nullptr, one.compliances.pOfNoStep(joint)});
    }
  }
  for (const FleetPair& pair : pairs) {
    if (pair.result && std::isfinite(pair.result->machine_p))
      questions.push_back({nullptr, 0, &pair, pair.result->machine_p});
  }
  return questions;
}

FleetStep complianceStep(const Fleet& fleet, const Charted& charted, const Step& step, double p_holm) {
  const DaySeries& series = fleet.series[charted.series];
  FleetStep found;
  found.machine = series.machine, found.series = charted.series, found.campaign = series.campaigns[step.first];
  found.days_before = step.first - step.begin, found.days_after = step.end - step.first;
  found.compliance = step, found.p_holm = p_holm;
  return found;
}

FleetStep geometryStep(const Fleet& fleet, const FleetPair& pair, double p_holm) {
  FleetStep found;
  found.what = FleetStep::What::geometry;
  found.machine = fleet.campaigns[pair.after].machine, found.campaign = pair.after;
  for (std::size_t s = 0; s < fleet.series.size(); ++s) {
    const auto& days = fleet.series[s].campaigns;
    const auto at = std::find(days.begin(), days.end(), pair.after);
    if (at == days.end()) continue;
    found.series = s;
    found.days_before = static_cast<std::size_t>(at - days.begin());
    found.days_after = static_cast<std::size_t>(days.end() - at);
  }
  found.size = pair.result->at_targets, found.p_holm = p_holm;
  return found;
}

/// Fills charts, and steps of compliances and geometries.
void studySeries(Fleet& fleet) {
  const std::vector<Charted> charted = chartedSeries(fleet);
  const std::vector<Question> questions = questionsOf(charted, fleet.pairs);
  std::vector<double> p_values;
  for (const Question& one : questions) p_values.push_back(one.p_value);
  const std::vector<double> corrected = comparison::holm(p_values);
  fleet.chart_questions = questions.size();
  std::map<const Charted*, PerJoint<std::vector<Step>>> steps;
  for (std::size_t q = 0; q < questions.size(); ++q) {
    if (!(corrected[q] <= kFleetLevel)) continue;
    const Question& one = questions[q];
    if (one.pair != nullptr) {
      fleet.steps.push_back(geometryStep(fleet, *one.pair, corrected[q]));
      continue;
    }
    // What is found first passes whatever Holm allowed it; further steps are held to what Bonferroni allows.
    const double level = kFleetLevel / static_cast<double>(questions.size());
    auto found = one.charted->compliances.steps(one.joint, std::max(level, one.p_value), level);
    for (const Step& step : found) {
      const double bonferroni = std::min(1.0, step.p_value * static_cast<double>(questions.size()));
      const double p = step.p_value <= one.p_value ? std::min(bonferroni, corrected[q]) : bonferroni;
      fleet.steps.push_back(complianceStep(fleet, *one.charted, step, p));
    }
    PerJoint<std::vector<Step>>& own = steps[one.charted];
    own.resize(static_cast<std::size_t>(one.charted->joints));
    own[static_cast<std::size_t>(one.joint)] = std::move(found);
  }
  for (const Charted& one : charted) {
    SeriesCharts charts;
    charts.series = one.series, charts.method = one.method, charts.same_postures = one.compliances.samePostures();
    const auto found = steps.find(&one);
    for (int joint = 0; joint < one.joints; ++joint) {
      charts.joints.push_back(one.compliances.chart(
          joint, found == steps.end() ? std::vector<Step>{} : found->second[static_cast<std::size_t>(joint)]));
      // What the first of Holm's questions is held to.
      const double level = kFleetLevel / static_cast<double>(std::max<std::size_t>(1, questions.size()));
      const std::size_t days = one.compliances.days();
      charts.detectable.push_back({one.compliances.detectableStep(joint, days / 2, level),
                                   one.compliances.detectableStep(joint, days - 1, level)});
    }
    fleet.charts.push_back(charts);
  }
}

std::set<std::string> effectsOf(const CampaignResult& day) {
  std::set<std::string> ids;
  for (const EffectFound& one : day.effects) ids.insert(one.effects.begin(), one.effects.end());
  return ids;
}

/// The only place where it turns from absent to present or back; 0 where there is none or more than one.
std::size_t turnOf(const std::vector<bool>& there) {
  std::size_t turn = 0;
  for (std::size_t t = 1; t < there.size(); ++t) {
    if (there[t] == there[t - 1]) continue;
    if (turn != 0) return 0;
    turn = t;
  }
  return turn;
}

/// Effects that appear or go, those of one date together; what is on the last day alone is in as well.
void studyEffects(Fleet& fleet) {
  for (std::size_t s = 0; s < fleet.series.size(); ++s) {
    std::vector<std::size_t> diagnosed;
    std::set<std::string> all;
    std::vector<std::set<std::string>> by_day;
    for (const std::size_t one : fleet.series[s].campaigns) {
      const CampaignResult& day = *fleet.campaigns[one].result;
      if (!day.diagnosed) continue;
      diagnosed.push_back(one);
      by_day.push_back(effectsOf(day));
      all.insert(by_day.back().begin(), by_day.back().end());
    }
    std::map<std::pair<std::size_t, bool>, std::vector<std::string>> turns;
    for (const std::string& effect : all) {
      std::vector<bool> there;
      for (const auto& ids : by_day) there.push_back(ids.contains(effect));
      const std::size_t turn = turnOf(there);
      if (turn >= 2) turns[{turn, there.back()}].push_back(effect);
    }
    for (const auto& [turn, effects] : turns) {
      const auto [first, appeared] = turn;
      if (!appeared && diagnosed.size() - first < 2) continue;
      FleetStep step;
      step.what = appeared ? FleetStep::What::effect_appeared : FleetStep::What::effect_gone;
      step.machine = fleet.series[s].machine, step.series = s, step.campaign = diagnosed[first];
      step.days_before = first, step.days_after = diagnosed.size() - first;
      step.effects = effects;
      fleet.steps.push_back(step);
    }
  }
}

bool isEffect(const FleetStep& step) {
  return step.what == FleetStep::What::effect_appeared || step.what == FleetStep::What::effect_gone;
}

Need needOf(const Fleet& fleet, const FleetStep& step) {
  const std::string& date = fleet.campaigns[step.campaign].date;
  switch (step.what) {
    case FleetStep::What::effect_appeared:
      if (step.days_after < 2)
        return {NeedId::perhaps_changed, Remark(RemarkId::effect_once, step.effects, date),
                Remark(RemarkId::confirm_change), step.campaign};
      return {NeedId::changed, Remark(RemarkId::effect_appeared, step.effects, date),
              Remark(RemarkId::inspect_effect, step.effects), step.campaign};
    case FleetStep::What::effect_gone:
      return {NeedId::changed, Remark(RemarkId::effect_gone, step.effects, date), Remark(RemarkId::confirm_change),
              step.campaign};
    case FleetStep::What::geometry:
      return {NeedId::changed, Remark(RemarkId::geometry_changed, date, step.size, step.p_holm),
              Remark(RemarkId::calibrate_again), step.campaign};
    case FleetStep::What::compliance:
      break;
  }
  const Stated share = step.compliance.share();
  // Without a share it is still known which way.
  const double change = std::isfinite(share.value)
                            ? share.value
                            : std::copysign(std::numeric_limits<double>::infinity(), step.compliance.difference.value);
  return {NeedId::changed,
          Remark(RemarkId::compliance_changed, step.compliance.joint + 1, change, share.high - share.value, date,
                 step.p_holm, step.days_after),
          Remark(RemarkId::inspect_joint, step.compliance.joint + 1), step.campaign};
}

std::vector<int> impreciseJoints(const CampaignResult& day) {
  std::vector<int> joints;
  if (day.kind != DayKind::loaded) return joints;  // own weight shows what it shows
  for (int j = 0; j < day.joints(); ++j) {
    const Stated& k = day.stiffness[static_cast<std::size_t>(j)];
    if (!std::isfinite(k.value)) continue;
    if (!std::isfinite(k.high) || !std::isfinite(k.low) || k.high - k.low > k.value) joints.push_back(j + 1);
  }
  return joints;
}

/// What the last day says by itself.
void addNeedsOfDay(const FleetCampaign& campaign, std::size_t place, std::vector<Need>& needs) {
  const auto add = [&](NeedId id, Remark reason, Remark next) {
    needs.push_back({id, std::move(reason), std::move(next), place});
  };
  const std::string& date = campaign.date;
  if (!campaign.result) {
    add(NeedId::no_result, Remark(RemarkId::no_result, date, campaign.failure), Remark(RemarkId::mend_campaign));
    return;
  }
  const CampaignResult& day = *campaign.result;
  using preparation::AuditVerdict;
  if (day.audit == AuditVerdict::fail)
    add(NeedId::audit_failed, Remark(RemarkId::audit_failed, date, day.failed_checks), Remark(RemarkId::measure_again));
  if (day.hasUnknown())
    add(NeedId::unknown_gap, Remark(RemarkId::unknown_gap, date), Remark(RemarkId::follow_next_measurement));
  if (day.audit == AuditVerdict::not_testable)
    add(NeedId::audit_not_testable, Remark(RemarkId::audit_not_testable, date),
        Remark(RemarkId::follow_next_measurement));
  if (const auto joints = impreciseJoints(day); !joints.empty())
    add(NeedId::joint_imprecise, Remark(RemarkId::joint_imprecise, joints, date),
        Remark(RemarkId::follow_next_measurement));
  if (day.audit == AuditVerdict::warn)
    add(NeedId::audit_warned, Remark(RemarkId::audit_warned, date, day.warned_checks), Remark(RemarkId::nothing_to_do));
}

void addScatter(const Fleet& fleet, const SeriesCharts& charts, std::vector<Need>& needs) {
  for (std::size_t j = 0; j < charts.joints.size(); ++j) {
    const ControlChart& chart = charts.joints[j];
    if (!std::isfinite(chart.scatter)) continue;
    if (chart.scatter_p * static_cast<double>(std::max<std::size_t>(1, fleet.chart_questions)) > kFleetLevel) continue;
    needs.push_back({NeedId::dates_scatter, Remark(RemarkId::dates_scatter, j + 1, chart.scatter),
                     Remark(RemarkId::repeat_same_postures), fleet.series[charts.series].campaigns.back()});
  }
}

/// Where several machines bear the name; returns their last days.
std::set<std::size_t> addSeveralMachines(const Fleet& fleet, const std::string& name, std::vector<Need>& needs) {
  std::vector<const Arm*> arms;
  std::set<std::size_t> last;
  for (const Arm& one : fleet.arms) {
    if (one.machine == name) arms.push_back(&one), last.insert(one.campaigns.back());
  }
  if (arms.size() < 2) return {};
  const std::size_t other = arms[1]->campaigns.front();
  needs.push_back({NeedId::several_machines,
                   Remark(RemarkId::several_machines, arms.size(), fleet.campaigns[arms[1]->differs_from].folder,
                          fleet.campaigns[other].folder, arms[1]->difference),
                   Remark(RemarkId::tell_machines_apart), other});
  return last;
}

Machine studiedMachine(const Fleet& fleet, const std::string& name, std::vector<std::size_t> campaigns) {
  Machine machine{name, std::move(campaigns), {}};
  const std::size_t last = machine.campaigns.back();
  std::set<std::size_t> last_days = addSeveralMachines(fleet, name, machine.needs);
  last_days.insert(last);
  // Earlier days without a result miss in the series, which somebody should know.
  for (const std::size_t one : machine.campaigns) {
    if (last_days.contains(one) || !fleet.campaigns[one].result)
      addNeedsOfDay(fleet.campaigns[one], one, machine.needs);
  }
  // Effects first: a base that gives looks like softer joints as well.
  for (const bool effects : {true, false}) {
    for (const FleetStep& step : fleet.steps) {
      if (step.machine == name && isEffect(step) == effects) machine.needs.push_back(needOf(fleet, step));
    }
  }
  for (const SeriesCharts& charts : fleet.charts) {
    if (fleet.series[charts.series].machine == name) addScatter(fleet, charts, machine.needs);
  }
  std::stable_sort(machine.needs.begin(), machine.needs.end(),
                   [](const Need& a, const Need& b) { return a.id < b.id; });
  if (machine.needs.empty()) machine.needs.push_back({NeedId::nothing, {}, Remark(RemarkId::nothing_to_do), last});
  return machine;
}

}  // namespace

void compareLoaded(const std::vector<FleetCampaign>& campaigns, std::vector<FleetPair>& pairs) {
  for (FleetPair& pair : pairs) {
    const CampaignResult &before = *campaigns[pair.before].result, &after = *campaigns[pair.after].result;
    if (before.kind == DayKind::loaded) pair.result = comparedLoaded(before, after);
  }
}

void compareUnloaded(const std::vector<FleetCampaign>& campaigns, std::vector<FleetPair>& pairs) {
  for (FleetPair& pair : pairs) {
    const CampaignResult &before = *campaigns[pair.before].result, &after = *campaigns[pair.after].result;
    if (before.kind != DayKind::unloaded || !pair.result || !showsOwnWeight({&before, &after})) continue;
    compareCompliances(before, after, ComplianceSeries({&before, &after}, std::nullopt), *pair.result);
  }
}

Fleet studyFleet(std::vector<FleetCampaign> campaigns, std::vector<FleetPair> pairs) {
  Fleet fleet;
  fleet.campaigns = std::move(campaigns);
  fleet.pairs = std::move(pairs);
  fleet.arms = armsOf(fleet.campaigns);
  fleet.series = seriesOf(fleet.campaigns);
  fleet.pair_questions = correctPairs(fleet.campaigns, fleet.pairs);
  studySeries(fleet);
  studyEffects(fleet);
  std::stable_sort(fleet.steps.begin(), fleet.steps.end(), [](const FleetStep& a, const FleetStep& b) {
    return std::tie(a.machine, a.campaign) < std::tie(b.machine, b.campaign);
  });
  std::map<std::string, std::vector<std::size_t>> by_machine;
  for (std::size_t i = 0; i < fleet.campaigns.size(); ++i) by_machine[fleet.campaigns[i].machine].push_back(i);
  for (const auto& [name, days] : by_machine) fleet.machines.push_back(studiedMachine(fleet, name, days));
  std::stable_sort(fleet.machines.begin(), fleet.machines.end(),
                   [](const Machine& a, const Machine& b) { return a.needs.front().id < b.needs.front().id; });
  return fleet;
}

}  // namespace stiffscope::fleet
