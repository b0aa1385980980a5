#pragma once

#include "core/diagnosis/diagnosis.h"
#include "core/extended_model/extended_model.h"
#include "core/identification/identify.h"
#include "core/preparation/prepare.h"

namespace stiffscope::extended_model {

/// `campaign`: as identification sees it. No effect added, or all of size zero: `with` is `without`.
ExtendedModel extendModel(const campaign::Campaign& campaign, EffectFit effects,
                          const identification::IdentifyOptions& options);

/// The model that the data support: the effects that the joint fit of a diagnosis chooses, joint springs alone where it
/// chooses none, and in the intervals what could still hide (hidden_effects.h). On a long day the effects are chosen,
/// and what could hide is weighed, on the postures that the diagnosis looks at; values are of all.
///
/// `prepared`: screened and corrected for drift. `campaign`: what is identified from, `prepared.campaign` or the same
/// day as it was read. Where there is no gap to look at, springs alone, with `hidden` empty and the reason in the
/// notes.
ExtendedModel supportedModel(const preparation::PreparedCampaign& prepared, const campaign::Campaign& campaign,
                             const identification::IdentifyOptions& options);

/// Puts the stiffnesses of the model's best method into a diagnosis of the same day: by springs alone, with the
/// effects, and the interval, so that the same question has one answer. Nothing where no method is available.
void stateStiffnesses(const ExtendedModel& model, diagnosis::Diagnosis& diagnosis);

}  // namespace stiffscope::extended_model
