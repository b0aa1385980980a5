#include "core/effects/all.h"

#include <array>

namespace stiffscope::effects {

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
  ModelScope scope{campaign.robot.joints(), {}, campaign.robot.rail.has_value()};
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
