#include "core/diagnosis/diagnose.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/diagnosis/confounding.h"
#include "core/diagnosis/gap_study.h"
#include "core/diagnosis/geometry_error.h"
#include "core/diagnosis/held_out.h"
#include "core/diagnosis/localization.h"
#include "core/diagnosis/next_measurement.h"
#include "core/diagnosis/significance.h"
#include "core/diagnosis/verdict.h"
#include "core/io/input_error.h"
#include "core/preparation/subsample.h"

namespace stiffscope::diagnosis {

namespace {

void requireLoads(const campaign::Campaign& campaign) {
  const io::InputPlace place{(campaign.folder / "campaign.xml").string(), 0, {}};
  if (!campaign.states || !campaign.load_cell) {
    throw io::InputError(place, "",
                         !campaign.states ? "no 'states': joint angles and load-cell readings are needed to diagnose"
                                          : "no 'load_cell': where the measured wrench acts is needed to diagnose");
  }
  if (!campaign.loading && !campaign.displacements) {
    throw io::InputError(place, "",
                         "neither 'loading' nor 'displacements': readings under load are needed to diagnose");
  }
  if (!identification::heaviestStep(campaign)) {
    throw io::InputError({(campaign.folder / campaign.states->file).string(), 0, {}}, "", "no load step has a force");
  }
}

class Diagnoser {
 public:
  Diagnoser(const preparation::PreparedCampaign& prepared, const GapStudy& study, const DiagnoseOptions& options)
      : prepared_(prepared),
        options_(options),
        start_(*study.start),
        input_(*study.input),
        allowed_(study.allowed),
        given_(study.given),
        fit_(study.fit) {
    result_.not_testable = study.not_testable;
  }

  Diagnosis run() {
    result_.unusable_reason = start_.reason;
    if (!start_.reason.empty()) return std::move(result_);
    const double chance = options_.chance_limit ? *options_.chance_limit
                                                : chanceLimit(input_, fit_, allowed_, options_.chance_draws,
                                                              options_.false_alarm, options_.seed);
    fit_.rules.detect = std::max(fit_.rules.detect, chance);
    describe();
    decide();
    if (options_.resamples > 0 && !options_.verdict_only) shrink();
    return std::move(result_);
  }

 private:
  void describe() {
    alone_ = withoutEffects(input_, start_.state, fit_);
    result_.usable = true;
    result_.postures = static_cast<int>(fit_.data.postures.size());
    for (const GapPosture& posture : fit_.data.postures) result_.states += static_cast<int>(posture.states.size());
    result_.state_noise = fit_.data.state_noise;
    result_.noise_source = start_.noise.source;
    result_.noise_factor_along = start_.noise.along_factor;
    result_.noise_factor_across = start_.noise.across_factor;
    result_.significance_limit = fit_.rules.detect;
    result_.size_limit = sizeOfDrop(fit_, fit_.rules.least_drop);
    result_.lack_of_fit = (alone_.projection.chi2_none - fit_.rules.other_rows) / fit_.rules.loading_rows;
    result_.left_over = leftPerEquation(fit_);
    result_.left_over_limit = fit_.left_limit;
    result_.model_error = fit_.model_error;
    result_.geometric_stiffness_share = start_.geometric_stiffness_share;
    before_ = stiffnessesAlone(alone_.data, std::vector<double>(alone_.data.postures.size(), 1.0), alone_.projection);
    after_ = allParameters(fit_.nuisances, fit_.set.effects);
    result_.gap = deflectionGap(alone_, before_, fit_, after_);
    result_.positions = positionGap(alone_, before_, fit_, after_);
    result_.positions_tested = input_.absolute;
    if (options_.verdict_only) return;
    result_.at_points = gapAtPoints(alone_.data, before_.for_deflection, fit_.data, after_);
    asMeasured();
    result_.where = whereDeflection(input_, alone_, before_.for_deflection);
    result_.where_after = whereDeflection(input_, fit_, after_);
    result_.where_positions = wherePosition(input_, alone_, before_.for_position);
    result_.aliases = designConfounding(input_, fit_, allowed_);
    result_.detectable = detectableSizes(input_, fit_, allowed_);
    stiffnesses();
  }

  /// Where the station's motion was taken off, the gap before is that of the readings as they are.
  void asMeasured() {
    if (given_.empty()) return;
    std::optional<GapAsMeasured> raw = gapAsMeasured(prepared_, input_, fit_, after_);
    if (!raw) return;
    if (raw->deflection) result_.gap.before = *raw->deflection;
    if (raw->position) result_.positions.before = *raw->position;
    result_.as_measured = std::move(raw->by_posture);
    result_.at_points = std::move(raw->at_points);
    station_ = std::move(raw->left);
  }

  void stiffnesses() {
    Eigen::VectorXd variance = complianceVariance(fit_, input_);
    const double scale = std::max(1.0, result_.left_over);
    for (Eigen::Index j = 0; j < 6; ++j) {
      const double before = before_.for_deflection[j], after = fit_.nuisances[j];
      const double sd = std::sqrt(scale * std::max(0.0, variance[j]));
      constexpr double kSeen = 3.0;  // standard deviations
      result_.identifiable[static_cast<std::size_t>(j)] = after > kSeen * sd;
      result_.stiffness_before[j] = before != 0.0 ? 1.0 / before : 0.0;
      result_.stiffness_after[j] = after != 0.0 ? 1.0 / after : 0.0;
      result_.stiffness_after_sd[j] = after != 0.0 ? sd / (after * after) : 0.0;
    }
  }

  void decide() {
    result_.geometry = geometryError(input_, fit_.state);
    const VerdictInput input{input_,           fit_,         allowed_,    start_.station,
                             result_.geometry, start_.noise, result_.gap, result_.positions};
    Decision decision = decideVerdict(input);
    result_.verdict = std::move(decision.verdict);
    result_.classes = std::move(decision.classes);
    if (options_.verdict_only) return;
    recipes_ = std::move(decision.recipes);
    for (const Tie& tie : decision.ties) {
      if (auto one = nextFor(input_, fit_, allowed_, tie, options_.seed)) result_.next.push_back(std::move(*one));
    }
  }

  void shrink() {
    std::vector<FitRecipe> recipes{{true, {}}};
    for (const auto& models : recipes_) recipes.push_back({false, models});
    const auto held_out = heldOutShrinks(input_, alone_, fit_, allowed_, recipes, options_.resamples, options_.seed);
    result_.shrink_together = held_out[0].deflection;
    HeldOutShrink station;
    if (!station_.empty()) {
      station = shrinkOver(station_, options_.resamples, options_.seed);
      result_.shrink_together = station.deflection;
    }
    const auto named = std::count_if(result_.classes.begin(), result_.classes.end(),
                                     [](const EffectClass& one) { return one.in_verdict; });
    for (std::size_t i = 0; i < result_.classes.size(); ++i) {
      EffectClass& one = result_.classes[i];
      // A verdict of one class is what the whole selection finds: its interval repeats that selection.
      const HeldOutShrink& own = one.in_verdict && named == 1 ? held_out[0] : held_out[i + 1];
      one.shrink = own.deflection;
      one.shrink_of_positions = own.position;
      one.explained = own.explained;
      const bool by_station = one.in_verdict && !given_.empty() &&
                              (one.effects.front() == effects::Effect::frame_error ||
                               one.effects.front() == effects::Effect::tracker_drift);
      if (!by_station) continue;
      one.shrink = station.deflection;
      one.shrink_of_positions = station.position;
      const double noise = result_.gap.noise * result_.gap.noise, whole = result_.gap.before * result_.gap.before;
      if (whole > 1.05 * noise) one.explained = (whole - result_.gap.after * result_.gap.after) / (whole - noise);
    }
  }

  const preparation::PreparedCampaign& prepared_;
  DiagnoseOptions options_;
  const DiagnosisInput& start_;
  const SystemInput& input_;
  const std::vector<bool>& allowed_;
  const std::vector<std::size_t>& given_;
  GapFit fit_;    // with the effects chosen, a copy: the limit of a finding is put into its rules
  GapFit alone_;  // joint stiffnesses alone
  StiffnessesAlone before_;
  Eigen::VectorXd after_;
  std::vector<std::vector<ChosenModel>> recipes_;
  std::vector<HeldOut>
      station_;  // by posture: readings as they are, and with the station's motion off and the verdict in
  Diagnosis result_;
};

Diagnosis diagnoseAll(const preparation::PreparedCampaign& prepared, const DiagnoseOptions& options) {
  const GapStudy study = studyGap(prepared, {options.noise_share, options.deflection_share, options.only});
  return Diagnoser(prepared, study, options).run();
}

/// What a long day has beside the postures that are looked at.
struct LongDay {
  std::vector<std::size_t> places;  ///< of the day's postures, those that are looked at
  std::size_t postures = 0;
  bool long_sweeps = false;

  explicit LongDay(const campaign::Campaign& campaign)
      : places(preparation::spreadPostures(campaign, preparation::kMostDiagnosed)),
        postures(campaign.pose_ids.size()),
        long_sweeps(preparation::hasLongSweep(campaign)) {}

  /// In the day's own numbers, saying what was left out.
  Diagnosis stated(Diagnosis diagnosis) const {
    if (long_sweeps) diagnosis.verdict.reasons.push_back(Remark(RemarkId::sweeps_thinned, preparation::kMostSwept));
    if (postures <= preparation::kMostDiagnosed) return diagnosis;
    for (PointGap& one : diagnosis.at_points) one.pose = static_cast<int>(places[static_cast<std::size_t>(one.pose)]);
    diagnosis.verdict.reasons.push_back(Remark(RemarkId::postures_thinned, postures, diagnosis.postures));
    return diagnosis;
  }
};

}  // namespace

Diagnosis diagnose(const campaign::Campaign& campaign, const DiagnoseOptions& options) {
  return diagnose(campaign::Campaign(campaign), options);
}

Diagnosis diagnose(campaign::Campaign&& campaign, const DiagnoseOptions& options) {
  requireLoads(campaign);
  preparation::PreparedCampaign prepared = preparation::prepareCampaign(std::move(campaign));
  if (!isLong(prepared.campaign)) return diagnoseAll(prepared, options);
  const LongDay day(prepared.campaign);
  prepared = spreadForDiagnosis(prepared);
  return day.stated(diagnoseAll(prepared, options));
}

Diagnosis diagnose(const preparation::PreparedCampaign& prepared, const DiagnoseOptions& options) {
  requireLoads(prepared.campaign);
  if (!isLong(prepared.campaign)) return diagnoseAll(prepared, options);
  return LongDay(prepared.campaign).stated(diagnoseAll(spreadForDiagnosis(prepared), options));
}

Diagnosis diagnose(const preparation::PreparedCampaign& prepared, const GapStudy& study,
                   const DiagnoseOptions& options) {
  requireLoads(prepared.campaign);
  if (!isLong(prepared.campaign)) return Diagnoser(prepared, study, options).run();
  return LongDay(prepared.campaign).stated(Diagnoser(spreadForDiagnosis(prepared), study, options).run());
}

}  // namespace stiffscope::diagnosis
