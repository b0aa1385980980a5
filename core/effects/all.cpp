#include "core/effects/all.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "core/campaign/state_points.h"
#include "core/robot/kinematics.h"

namespace stiffscope::effects {

namespace {

/// By what each reflector moved from step 0 to each later state, m, by posture and step.
std::multimap<std::pair<int, int>, double> movesOf(const campaign::Campaign& campaign) {
  std::multimap<std::pair<int, int>, double> moves;
  if (!campaign.loading) {
    if (!campaign.displacements) return moves;
    for (const campaign::Displacement& row : campaign.displacements->rows)
      moves.emplace(std::pair(row.pose, row.step), row.displacement.norm());
    return moves;
  }
  const std::vector<campaign::StatePoints> states = campaign::statePoints(campaign);
  std::map<int, const campaign::StatePoints*> unloaded;
  for (const campaign::StatePoints& state : states) {
    if (state.source == campaign::StatePoints::Source::loading && state.step == 0) unloaded[state.pose] = &state;
  }
  for (const campaign::StatePoints& state : states) {
    const auto before = unloaded.find(state.pose);
    if (state.step == 0 || before == unloaded.end()) continue;
    for (const campaign::ReflectorMean& one : state.reflectors) {
      const campaign::ReflectorMean* const from = before->second->of(one.target);
      if (from != nullptr) moves.emplace(std::pair(state.pose, state.step), (one.point - from->point).norm());
    }
  }
  return moves;
}

}  // namespace

double armCompliance(const campaign::Campaign& campaign) {
  if (!campaign.states) return 0.0;
  const auto moves = movesOf(campaign);
  double most = 0.0;
  for (const campaign::State& state : campaign.states->rows)
    most = std::max(most, state.wrench_in_cell.head<3>().norm());
  std::vector<double> compliances;
  for (const campaign::State& state : campaign.states->rows) {
    const double force = state.wrench_in_cell.head<3>().norm();
    if (state.step == 0 || force <= campaign::kReturnShare * most) continue;
    const robot::ArmPosture posture = robot::postureAt(campaign.robot, state.q);
    const double reach = robot::flangeAt(campaign.robot, posture).translation().norm();
    const auto [first, last] = moves.equal_range({state.pose, state.step});
    for (auto move = first; move != last; ++move) compliances.push_back(move->second / (force * reach * reach));
  }
  if (compliances.empty()) return 0.0;
  const auto middle = compliances.begin() + static_cast<std::ptrdiff_t>(compliances.size() / 2);
  std::nth_element(compliances.begin(), middle, compliances.end());
  return *middle;
}

const EffectRecord& recordOf(Effect effect) {
#define STIFFSCOPE_EFFECT_FUNCTION(id, record) &record,
  static constexpr std::array<const EffectRecord& (*)(), kEffectCount> kRecords{
      STIFFSCOPE_EFFECTS(STIFFSCOPE_EFFECT_FUNCTION)};
#undef STIFFSCOPE_EFFECT_FUNCTION
  return kRecords[static_cast<std::size_t>(effect)]();
}

std::vector<EffectModel> modelsOf(const EffectRecord& record, const ModelScope& scope) {
  if (record.models == nullptr) return {};
  std::vector<EffectModel> models = record.models(scope);
  for (EffectModel& model : models) model.effect = record.effect;
  return models;
}

std::vector<EffectModel> effectModels(const ModelScope& scope) {
  std::vector<EffectModel> all;
  for (std::size_t e = 0; e < kEffectCount; ++e) {
    for (EffectModel& model : modelsOf(recordOf(static_cast<Effect>(e)), scope)) all.push_back(std::move(model));
  }
  return all;
}

std::vector<EffectModel> effectModelsOf(const campaign::Campaign& campaign) {
  ModelScope scope{campaign.robot.joints(), {}, campaign.robot.rail.has_value(), armCompliance(campaign)};
  for (const campaign::Target& target : campaign.targets) scope.targets.push_back(target.id);
  return effectModels(scope);
}

EffectNature natureOf(Effect effect) { return recordOf(effect).nature; }

bool concerns(Effect effect, bool on_rail) { return on_rail || !recordOf(effect).of_rail; }

bool entersCompensation(Effect effect) {
  return natureOf(effect) == EffectNature::machine || natureOf(effect) == EffectNature::load;
}

Remark missingFor(Effect effect, const CampaignContents& contents) {
  const EffectRecord& record = recordOf(effect);
  return record.missing ? record.missing(contents) : Remark();
}

}  // namespace stiffscope::effects
