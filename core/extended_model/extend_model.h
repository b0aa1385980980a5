#pragma once

#include <functional>
#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "core/extended_model/extended_model.h"
#include "core/extended_model/fitted_effects.h"
#include "core/extended_model/method_equations.h"
#include "core/identification/identify.h"
#include "core/identification/load_case.h"
#include "core/preparation/prepare.h"

namespace stiffscope::extended_model {

/// `campaign`: as identification sees it. No effect added, or all of size zero: `with` is `without`.
/// Where estimates alone are asked for (IdentifyOptions::estimates_only) `without` of a long day is of the postures
/// that the diagnosis looks at, and `with` has the one method that frames need (IdentifyOptions::for_frames): neither
/// is shown then, and `without` tells only whether springs alone contradict themselves and how far the frames move with
/// the effects.
ExtendedModel extendModel(const campaign::Campaign& campaign, EffectFit effects,
                          const identification::IdentifyOptions& options);

/// Whether a diagnosis of the same day will be made of the model's study.
enum class Followed { by_nothing, by_diagnosis };

/// The model that the data support: the effects that the joint fit of a diagnosis chooses, joint springs alone where it
/// chooses none, and in the intervals what could still hide (hidden_effects.h). On a long day the effects are chosen,
/// and what could hide is weighed, on the postures that the diagnosis looks at; values are of all.
///
/// `prepared`: screened and corrected for drift. `campaign`: what is identified from, `prepared.campaign` or the same
/// day as it was read. Where there is no gap to look at, springs alone, with `hidden` empty and the reason in the
/// notes. Where no diagnosis follows the study has no equations (GapStudy::keepStates).
ExtendedModel supportedModel(const preparation::PreparedCampaign& prepared, const campaign::Campaign& campaign,
                             const identification::IdentifyOptions& options, Followed followed = Followed::by_nothing);

/// The model that `make` makes of the day with these options. Where they say `robust` and postures disagree with it,
/// that of the day without these: the effects, the intervals and what is declared must not stand on them either.
ExtendedModel withoutOutlying(const preparation::PreparedCampaign& prepared,
                              const identification::IdentifyOptions& options,
                              const std::function<ExtendedModel(const preparation::PreparedCampaign&,
                                                                const identification::IdentifyOptions&)>& make);

/// Puts the stiffnesses of the model's best method into a diagnosis of the same day: by springs alone, with the
/// effects, and the interval, so that the same question has one answer. Nothing where no method is available.
void stateStiffnesses(const ExtendedModel& model, diagnosis::Diagnosis& diagnosis);

/// Judges the methods of `model.with` with the effects in the model: displacements are the machine's own, and on every
/// subset of postures (all up to a thousand, else a thousand drawn, and
/// fewer of a long day) effects and springs are fitted anew, the effects by
/// one linear step, the equations following them to first order. Fills shares, residuals, `subsets`, and the bootstrap
/// where it is asked for, of every available method, `model.spread.compliance`, and the displacements by case.
void evaluateExtended(const identification::IdentifyOptions& options, const std::vector<CaseEffects>& cases,
                      ExtendedModel& model);

/// The campaign as it would have been read without the effects: what is left is the day of a machine with joint springs
/// and nothing else, which frames, calibration and methods then stand on. Off every reading of loading, displacements
/// and, where they took part in the fit, sweeps goes what the effects add in its state (PostureOffsets), own weight's
/// part included. Effects that act through the wrench change the load cell's declared point (load_point_error) or the
/// readings in `states` (misalignment, bias); a moved frame is undone by its finite motion.
///
/// Postures whose loaded readings the fit does not have (no reflector read in all load steps) cannot be corrected and
/// are left out, named in `left_out`. Throws InputError where the load cell's point does not move with the flange and
/// is to be corrected.
campaign::Campaign correctedFor(const EffectFit& effects, const campaign::Campaign& campaign,
                                std::vector<identification::LeftOutPosture>& left_out);

}  // namespace stiffscope::extended_model
