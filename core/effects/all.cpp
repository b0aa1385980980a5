#include "core/effects/all.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "core/robot/kinematics.h"

namespace stiffscope::effects {

namespace {

struct Mean {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;

  Eigen::Vector3d value() const { return sum / count; }
};

/// Means of the repeats by posture, step and reflector, of every so many postures; differences from step 0 where the
/// campaign has no more.
std::map<std::tuple<int, int, int>, Mean> meansOf(const campaign::Campaign& campaign, int every) {
  std::map<std::tuple<int, int, int>, Mean> means;
  const auto add = [&](const auto& row, const Eigen::Vector3d& value) {
    if (row.pose % every != 0) return;
    Mean& mean = means[{row.pose, row.step, row.target}];
    mean.sum += value;
    ++mean.count;
  };
  if (campaign.loading) {
    for (const campaign::LoadingReading& row : campaign.loading->rows) add(row, row.point);
  } else if (campaign.displacements) {
    for (const campaign::Displacement& row : campaign.displacements->rows) add(row, row.displacement);
  }
  return means;
}

}  // namespace

double armCompliance(const campaign::Campaign& campaign) {
  if (!campaign.states) return 0.0;
  constexpr int kPostures = 100;
  const int every = static_cast<int>(campaign.pose_ids.size()) / kPostures + 1;
  const auto means = meansOf(campaign, every);
  double most = 0.0;
  for (const campaign::State& state : campaign.states->rows)
    most = std::max(most, state.wrench_in_cell.head<3>().norm());
  std::vector<double> compliances;
  for (const campaign::State& state : campaign.states->rows) {
    const double force = state.wrench_in_cell.head<3>().norm();
    if (state.step == 0 || force <= campaign::kReturnShare * most) continue;
    const robot::ArmPosture posture = robot::postureAt(campaign.robot, state.q);
    const double reach = robot::flangeAt(campaign.robot, posture).translation().norm();
    for (int target = 0; target < static_cast<int>(campaign.targets.size()); ++target) {
      const auto loaded = means.find({state.pose, state.step, target});
      if (loaded == means.end()) continue;
      const auto unloaded = means.find({state.pose, 0, target});
      if (campaign.loading && unloaded == means.end()) continue;
      const Eigen::Vector3d from = campaign.loading ? unloaded->second.value() : Eigen::Vector3d::Zero();
      compliances.push_back((loaded->second.value() - from).norm() / (force * reach * reach));
    }
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
