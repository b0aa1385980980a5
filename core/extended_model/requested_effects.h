#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/gap_study.h"
#include "core/extended_model/remarks.h"
#include "core/io/input_error.h"
#include "metrology/remark.h"

namespace stiffscope::extended_model {

/// Where a message about a requested effect points.
inline const io::InputPlace kWithOption{"--with"};

/// An effect that the model is to have.
struct RequestedEffect {
  effects::Effect effect = effects::Effect::link_compliance;
  std::vector<std::string> parts;  ///< as its model names them ("joint 3"); empty: those that stand out
  std::string shape = {};          ///< the one of its models that is meant; empty: the best
};

/// What the model is to have besides joint springs, and what there is to say about how it came to that.
struct RequestedEffects {
  std::vector<RequestedEffect> effects;
  std::vector<Remark> notes;
};

/// Effects by words such as `bearing_tilt`, `bearing_tilt:3`, `joint_coupling:2-3`, `target_motion:P12`; an effect that
/// comes again with another detail has both. Throws InputError with the nearest known name.
RequestedEffects requestedEffects(const std::vector<std::string>& words, const campaign::Campaign& campaign);

/// What a diagnosis names: the first, which fits best, of effects that it cannot tell apart. Nothing, and why,
/// where it names none, or only `unknown`.
RequestedEffects namedBy(const diagnosis::Diagnosis& diagnosis);

/// What the joint fit of a diagnosis has chosen, part by part; without what the nests put in, which preparation has
/// corrected the readings for.
RequestedEffects chosenBy(const diagnosis::GapStudy& study);

}  // namespace stiffscope::extended_model
