#include "core/diagnosis/gap_study.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/diagnosis/preconditions.h"
#include "core/effects/all.h"
#include "core/preparation/subsample.h"

namespace stiffscope::diagnosis {

namespace {

std::size_t modelOf(const std::vector<effects::EffectModel>& models, effects::Effect effect) {
  return static_cast<std::size_t>(std::find_if(models.begin(), models.end(),
                                               [&](const effects::EffectModel& one) { return one.effect == effect; }) -
                                  models.begin());
}

/// With one effect wanted: its models, and those of a station that moved, which nests may put in.
std::vector<effects::EffectModel> modelsFor(const campaign::Campaign& campaign,
                                            const std::optional<effects::Effect>& only) {
  std::vector<effects::EffectModel> models = effects::effectModelsOf(campaign);
  std::erase_if(models, [&](const effects::EffectModel& one) {
    return only && one.effect != *only && one.effect != effects::Effect::tracker_drift &&
           one.effect != effects::Effect::frame_error;
  });
  return models;
}

/// Which models the campaign can show, and what the others lack.
void evaluatePreconditions(const GapOptions& options, const SystemInput& input, GapStudy& study) {
  const effects::CampaignContents has = whatIsThere(input, study.start->state, study.start->station);
  study.allowed.assign(input.models.size(), true);
  for (std::size_t e = 0; e < effects::kEffectCount; ++e) {
    const auto effect = static_cast<effects::Effect>(e);
    const Remark missing = effects::missingFor(effect, has);
    if (missing.empty() || !effects::concerns(effect, input.campaign.robot.rail.has_value())) continue;
    study.not_testable.push_back({effect, missing});
    for (std::size_t m = 0; m < input.models.size(); ++m) {
      if (input.models[m].effect == effect) study.allowed[m] = false;
    }
  }
  for (std::size_t m = 0; options.only && m < input.models.size(); ++m) {
    if (input.models[m].effect != *options.only) study.allowed[m] = false;
  }
}

/// What the nests say of the station: a drift that they follow, or a jump, is in the model whatever it brings.
void takeStation(DiagnosisInput& start, SystemInput& input, GapStudy& study) {
  boundDriftByNests(start, input);
  const std::size_t drift = modelOf(input.models, effects::Effect::tracker_drift);
  const std::size_t frame = modelOf(input.models, effects::Effect::frame_error);
  if (start.station.course == preparation::StationCourse::drifted) {
    input.wandering = &start.station;
    study.given = {drift, frame};
  } else if (start.station.course == preparation::StationCourse::jumped) {
    study.allowed[drift] = false;
    study.given = {frame};
  }
}

}  // namespace

void GapStudy::keepStates() {
  LinearSystem states;
  states.layout = fit.data->layout;
  for (const GapPosture& posture : fit.data->postures) {
    GapPosture& own = states.postures.emplace_back();
    own.pose = posture.pose;
    own.states = posture.states;
  }
  fit.data = std::make_shared<const LinearSystem>(std::move(states));
  fit.by_geometry.reset();
  alone.reset();
}

GapStudy studyGap(const preparation::PreparedCampaign& prepared, const GapOptions& options) {
  GapStudy study;
  auto start = std::make_unique<DiagnosisInput>(diagnosisInput(prepared));
  auto input = std::make_unique<SystemInput>(
      SystemInput{start->campaign, start->noise.noise, prepared.campaign.load_cell->force_sigma,
                  prepared.campaign.load_cell->moment_sigma, modelsFor(prepared.campaign, options.only),
                  start->absolute, start->sweeps, complianceExpected(start->state.at.compliance)});
  if (prepared.rail) input->carriage = prepared.rail->of_stop;
  DiagnosisInput& begun = *start;
  study.start = std::move(start);
  if (study.usable()) {
    evaluatePreconditions(options, *input, study);
    takeStation(begun, *input, study);
    const FitRules rules{options.noise_share, options.deflection_share, begun.noise.degrees, study.given,
                         !options.only};
    study.fit = fitGap(*input, begun.state, study.allowed, rules);
  }
  study.input = std::move(input);
  return study;
}

bool isLong(const campaign::Campaign& campaign) {
  return campaign.pose_ids.size() > preparation::kMostDiagnosed || preparation::hasLongSweep(campaign) ||
         campaign.targets.size() > preparation::kMostReflectors;
}

campaign::Campaign spreadForDiagnosis(const campaign::Campaign& campaign) {
  if (campaign.targets.size() <= preparation::kMostReflectors)
    return preparation::evenlySpread(campaign, preparation::kMostDiagnosed);
  // Postures are those of all reflectors, and a sweep's readings are spread over the reflectors that stay.
  return preparation::evenlySpread(
      preparation::ofFirstReflectors(
          preparation::evenlySpread(campaign, preparation::kMostDiagnosed, std::numeric_limits<std::size_t>::max()),
          preparation::kMostReflectors),
      preparation::kMostDiagnosed);
}

preparation::PreparedCampaign spreadForDiagnosis(const preparation::PreparedCampaign& prepared) {
  return {spreadForDiagnosis(prepared.campaign),
          prepared.preparation,
          {},
          prepared.scatter,
          prepared.noise,
          prepared.drift,
          prepared.rail};
}

}  // namespace stiffscope::diagnosis
