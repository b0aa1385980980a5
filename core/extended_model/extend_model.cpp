#include "core/extended_model/extend_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/diagnosis/diagnose.h"
#include "core/diagnosis/held_out.h"
#include "core/diagnosis/localization.h"
#include "core/extended_model/effect_fit.h"
#include "core/extended_model/hidden_effects.h"
#include "core/extended_model/method_equations.h"
#include "core/identification/estimate.h"
#include "core/identification/outliers.h"
#include "core/identification/remarks.h"
#include "core/identification/shown_first.h"
#include "core/identification/warnings.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::extended_model {

namespace {

/// Equations that a method fits: three a reflector and case; of Complete Pose six a case.
double rowsOf(const identification::MethodResult& method, identification::Method which) {
  double rows = 0.0;
  for (const identification::CaseEquations& one : method.target_rows)
    rows += which == identification::Method::complete_pose ? 6.0 : static_cast<double>(one.right.size());
  return rows;
}

void addEffectsUncertainty(ExtendedModel& model) {
  const auto taken = static_cast<double>(model.effects.free.size());
  for (const identification::Method which : identification::kMethods) {
    identification::MethodResult& method = model.with.methods[static_cast<std::size_t>(which)];
    if (!method.available) continue;
    identification::StiffnessEstimate& estimate = method.estimate;
    const auto unknowns =
        static_cast<double>(std::count(estimate.identifiable.begin(), estimate.identifiable.end(), true));
    const double rows = rowsOf(method, which);
    if (rows > unknowns + taken) {
      const double factor = (rows - unknowns) / (rows - unknowns - taken);
      estimate.sigma *= std::sqrt(factor);
      estimate.parts.scatter *= factor;
    }
    const auto& columns = model.spread.compliance[static_cast<std::size_t>(which)];
    estimate.parts.effects = columns * columns.transpose();
    estimate.covariance = estimate.parts.total();
  }
}

/// Lets go what the result of springs alone is not asked for where estimates alone are wanted: cases and equations,
/// which of a long day are as large as the readings.
void keepStatements(identification::Identification& alone) {
  alone.cases = {};
  alone.wrist = {};
  for (identification::MethodResult& method : alone.methods)
    method.wrist_rows = {}, method.target_rows = {}, method.pose_rows = {};
}

/// Joint springs alone beside a model with effects. Estimates alone show nothing of them: they only tell how far they
/// are from that model's, for which the postures that a long day's diagnosis looks at serve.
identification::Identification springsBeside(const campaign::Campaign& campaign,
                                             const identification::IdentifyOptions& options) {
  if (!options.estimates_only || !diagnosis::isLong(campaign)) return identification::identify(campaign, options);
  return identification::identify(diagnosis::spreadForDiagnosis(campaign), options);
}

}  // namespace

ExtendedModel extendModel(const campaign::Campaign& campaign, EffectFit effects,
                          const identification::IdentifyOptions& options) {
  ExtendedModel model;
  model.effects = std::move(effects);
  const bool for_frames = options.estimates_only && diagnosis::isLong(campaign);
  // Effects of size zero change nothing and have no covariance to propagate.
  if (model.effects.free.empty()) {
    identification::IdentifyOptions own = options;
    own.for_frames = for_frames;
    model.with = identification::identify(campaign, own);
    model.without = for_frames ? springsBeside(campaign, options) : model.with;
    if (options.estimates_only) keepStatements(model.without);
    model.campaign = campaign;
    return model;
  }
  model.without = springsBeside(campaign, options);
  std::vector<identification::LeftOutPosture> left_out;
  model.campaign = correctedFor(model.effects, campaign, left_out);
  identification::IdentifyOptions own = identification::valuesOnly(options);
  own.robust = options.robust;
  own.for_frames = for_frames;
  model.with = identification::identify(model.campaign, own);
  model.with.left_out.insert(model.with.left_out.end(), left_out.begin(), left_out.end());
  if (!options.estimates_only) {
    model.spread.parameters = covarianceRoot(model.effects.covariance);
    const std::vector<CaseEffects> cases = caseEffects(model.effects, model.spread.parameters, model.with);
    evaluateExtended(options, cases, model);
    addEffectsUncertainty(model);
  }
  model.with.shown_first = identification::methodShownFirst(model.with, options.papers_choice);
  model.with.cautions = identification::warningsOf(model.campaign, model.with);
  return model;
}

namespace {

/// The study's effects, and nothing where one of them cannot be fitted.
EffectFit chosenEffects(const preparation::PreparedCampaign& prepared, const diagnosis::GapStudy& study) {
  EffectFit none;
  try {
    EffectFit chosen = fitEffects(prepared, chosenBy(study));
    if (chosen.free.empty() || !(chosen.shrink.high <= 0.0)) return chosen;  // or too few postures to tell
    none.notes.emplace_back(RemarkId::effects_do_not_help);
  } catch (const UnfitEffect& error) {
    none.notes.push_back(error.reason());
  }
  return none;
}

/// Gap and shrink as the diagnosis states them, of the study's own fit, the selection repeated inside the shrink. What
/// the nests put in is off the readings here and not there, so then the fit's own stand. Returns whether unloaded
/// positions contradict the fit, so that they speak for no effect.
bool describeAsDiagnosed(diagnosis::GapStudy& study, EffectFit& chosen) {
  if (chosen.free.empty() || !study.given.empty()) return false;
  const diagnosis::GapFit& fit = study.fit;
  const diagnosis::GapFit& alone =
      study.alone.emplace(diagnosis::withoutEffects(*study.input, study.start->state, fit));
  const diagnosis::StiffnessesAlone before =
      diagnosis::stiffnessesAlone(*alone.data, std::vector<double>(alone.data->postures.size(), 1.0), alone.projection);
  const Eigen::VectorXd after = diagnosis::allParameters(fit.nuisances, fit.set.effects);
  chosen.gap = diagnosis::deflectionGap(alone, before, fit, after);
  const diagnosis::DiagnoseOptions as_there;
  const diagnosis::HeldOutShrink held_out = diagnosis::heldOutShrinks(*study.input, alone, fit, study.allowed,
                                                                      {{true, {}}}, as_there.resamples, as_there.seed)
                                                .front();
  study.held_out = {fit.rules.detect, as_there.resamples, as_there.seed, held_out};
  chosen.shrink = held_out.deflection;
  chosen.explained = held_out.explained;
  return diagnosis::positionsLeft(fit, diagnosis::positionGap(alone, before, fit, after)).beyondLimit();
}

/// More than noise in the residual is said, whatever its size; that joints change as the day goes on, or as a load
/// stands; and that the sag's doubt is in the frames' uncertainty.
void cautionBeside(const CourseOfDay& course, ExtendedModel& model) {
  if (course.standing != 0.0) model.with.cautions.emplace_back(RemarkId::moves_while_load_stands, course.standing);
  if (course.over_day != 0.0)
    model.with.cautions.emplace_back(RemarkId::changes_over_the_day, 2.0 * course.over_day, course.over_day_t);
  if (model.with.frames.covariance.hidden.size() > 0) {
    for (Remark& one : model.with.cautions) {
      if (one.is(identification::RemarkId::sag_in_sweeps))
        one = Remark(identification::RemarkId::sag_in_sweeps_weighed, model.with.frames.largest_sag);
    }
  }
  if (model.residualIsNoise()) return;
  for (const Remark& one : model.with.cautions) {
    if (one.is(identification::RemarkId::residual_above_noise)) return;
  }
  model.with.cautions.emplace_back(RemarkId::residual_beyond_noise, model.leftOver(), model.hidden->lack_of_fit,
                                   model.hidden->unexplained, model.study->fit.state.model_error);
}

/// The effects in sizes that leave no stiffness negative (HiddenEffects::to_possible), or none where hardly any do: the
/// readings are then corrected for what the stiffnesses are stated with.
EffectFit inPossibleSizes(const diagnosis::GapStudy& study, const HiddenEffects& hidden, EffectFit fitted) {
  const EffectColumns& columns = hidden.draws.columns;
  const diagnosis::GapLayout& layout = study.fit.data->layout;
  Eigen::VectorXd& sizes = fitted.fit.set.effects;
  bool any = false;
  for (std::size_t i = 0; i < fitted.fit.set.models.size(); ++i) {
    const diagnosis::ChosenModel& one = fitted.fit.set.models[i];
    const effects::EffectModel& model = fitted.input->models[one.model];
    for (const std::size_t m : columns.models) {
      if (study.input->models[m].effect != model.effect || study.input->models[m].shape != model.shape) continue;
      const Eigen::Index first = layout.model_at[m] - layout.effects;
      for (std::size_t k = 0; k < columns.parameters.size(); ++k) {
        const Eigen::Index own = columns.parameters[k] - first;
        if (own < 0 || own >= static_cast<Eigen::Index>(model.parameters())) continue;
        const Eigen::Index at = fitted.firstOf(one) + own;
        if (sizes[at] == 0.0) continue;  // a part that was not chosen
        sizes[at] += (*hidden.to_possible)[static_cast<Eigen::Index>(k)];
        any = any || std::abs(sizes[at]) > 1e-9 * std::abs((*hidden.to_possible)[static_cast<Eigen::Index>(k)]);
      }
    }
  }
  if (!any) {
    EffectFit none;
    none.notes.emplace_back(RemarkId::effects_make_negative);
    return none;
  }
  describeSizes(fitted);
  fitted.notes.emplace_back(RemarkId::sizes_leave_none_negative);
  return fitted;
}

/// Whether joint springs come out negative one and all: then no model of the machine is to be looked for.
bool contradicted(const identification::Identification& springs) {
  bool any = false;
  for (const identification::MethodResult& method : springs.methods) {
    if (!method.available) continue;
    for (int j = 0; j < method.estimate.joints(); ++j) {
      if (!method.estimate.identifiable[static_cast<std::size_t>(j)]) continue;
      if (method.estimate.compliance[j] > 0.0) return false;
      any = true;
    }
  }
  return any;
}

}  // namespace

ExtendedModel supportedModel(const preparation::PreparedCampaign& prepared, const campaign::Campaign& campaign,
                             const identification::IdentifyOptions& options, Followed followed) {
  const bool thinned = diagnosis::isLong(prepared.campaign);
  std::optional<preparation::PreparedCampaign> spread;
  if (thinned) spread = diagnosis::spreadForDiagnosis(prepared);
  auto whole = std::make_unique<diagnosis::GapStudy>(diagnosis::studyGap(spread ? *spread : prepared));
  diagnosis::GapStudy& study = *whole;
  if (!study.usable()) {
    EffectFit none;
    none.notes.emplace_back(RemarkId::diagnosis_has_no_gap, study.start->reason);
    return extendModel(campaign, std::move(none), options);
  }
  EffectFit chosen = chosenEffects(spread ? *spread : prepared, study);
  const bool positions_refuted = describeAsDiagnosed(study, chosen);
  if (followed == Followed::by_nothing) study.keepStates();
  // Chosen anew on the other postures, what they choose makes those left out worse: it is not this machine's. Nor is
  // what the deflections hardly show, where the positions that do show it contradict the model beyond that.
  if (!chosen.free.empty() && (chosen.shrink.value <= 0.0 || (positions_refuted && chosen.shrink.low <= 0.0))) {
    chosen = {};
    chosen.notes.emplace_back(RemarkId::effects_do_not_help);
  }
  // A long day's: the postures that the study has, without the effects, for what could still hide.
  campaign::Campaign seen;
  identification::Identification seen_by_springs;
  if (thinned) {
    std::vector<identification::LeftOutPosture> left_out;
    seen = chosen.free.empty() ? spread->campaign : correctedFor(chosen, spread->campaign, left_out);
    seen_by_springs = identification::identify(seen, identification::estimatesOnly(options));
    chosen = overWholeDay(std::move(chosen), prepared);
  }
  ExtendedModel model = extendModel(campaign, std::move(chosen), options);
  // Springs alone as every command of a long day has them, whatever else it asks for.
  std::optional<identification::Identification> of_spread;
  if (thinned && !options.estimates_only) of_spread = springsBeside(campaign, identification::estimatesOnly(options));
  const identification::Identification& alone = of_spread ? *of_spread : model.without;
  if (contradicted(alone)) {
    EffectFit none;
    none.notes.emplace_back(RemarkId::springs_contradicted);
    return extendModel(campaign, std::move(none), options);
  }
  CourseOfDay course;
  const auto weigh = [&] {
    Declared declared = declaredOf(model.campaign, model.with, options);
    if (!options.estimates_only) course = courseOfDay(model.campaign, model.with);
    addCourse(course, model.with, declared);
    model.hidden =
        weighHiddenEffects(study, model.effects, thinned ? seen : model.campaign,
                           thinned ? seen_by_springs : model.with, model.without, alone.frames, declared, model.with);
  };
  weigh();
  // A long day's `seen` has been corrected for the fitted sizes.
  if (model.hidden->to_possible && !thinned) {
    model = extendModel(campaign, inPossibleSizes(study, *model.hidden, std::move(model.effects)), options);
    weigh();
  }
  model.study = std::move(whole);
  // What is known from elsewhere is held against the intervals that are stated.
  if (!model.campaign.known_stiffness.empty())
    model.with.cautions = identification::warningsOf(model.campaign, model.with);
  cautionBeside(course, model);
  return model;
}

ExtendedModel withoutOutlying(const preparation::PreparedCampaign& prepared,
                              const identification::IdentifyOptions& options,
                              const std::function<ExtendedModel(const preparation::PreparedCampaign&,
                                                                const identification::IdentifyOptions&)>& make) {
  ExtendedModel model = make(prepared, options);
  const std::vector<identification::OutlyingPosture> outlying = model.with.outlying;
  // Joint springs alone have left them out already.
  if (!options.robust || outlying.empty() || (!model.study && model.effects.added.empty())) return model;
  preparation::PreparedCampaign rest = prepared;
  rest.campaign = identification::withoutPostures(prepared.campaign, outlying);
  identification::IdentifyOptions all_of_them = options;
  all_of_them.robust = false;
  model = make(rest, all_of_them);
  for (identification::Identification* const result : {&model.with, &model.without}) {
    std::erase_if(result->cautions,
                  [](const Remark& one) { return one.is(identification::RemarkId::outlying_postures); });
    result->outlying = outlying;
    result->robust = true;
    identification::nameLeftOut(prepared.campaign, outlying, result->left_out);
    result->cautions.push_back(identification::outlyingWarning(prepared.campaign, *result));
  }
  return model;
}

void stateStiffnesses(const ExtendedModel& model, diagnosis::Diagnosis& diagnosis) {
  const identification::Method which = identification::bestMethod(model.with);
  if (!model.with.of(which).available || !model.without.of(which).available) return;
  const identification::StiffnessEstimate& estimate = model.with.of(which).estimate;
  const identification::StiffnessEstimate& alone = model.without.of(which).estimate;
  diagnosis::StatedStiffness& stated = diagnosis.stated.emplace();
  stated.method = which;
  stated.expanded.setZero(estimate.joints());
  stated.interval.resize(estimate.identifiable.size());
  diagnosis.identifiable = estimate.identifiable;
  for (int j = 0; j < estimate.joints(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    if (!estimate.identifiable[at]) continue;
    diagnosis.stiffness_before[j] = alone.stiffness(j);
    diagnosis.stiffness_after[j] = estimate.stiffness(j);
    diagnosis.stiffness_after_sd[j] = estimate.stiffnessSd(j);
    stated.expanded[j] = identification::expandedUncertainty(estimate, j);
    stated.interval[at] = identification::stiffnessInterval(estimate, j);
  }
}

}  // namespace stiffscope::extended_model
