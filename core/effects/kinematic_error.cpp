#include "core/effects/all.h"

namespace stiffscope::effects {

// Lengths or joint zeros differ from the nominal geometry. It has no columns: the geometry is a nuisance of
// every fit, and what the fit finds is held against the nominal one (core/diagnosis/geometry_error.h).

namespace {

std::string kinematicErrorMissing(const CampaignContents& has) {
  if (!has.weights) return "the masses of the links are not known: the sag cannot be told from geometry";
  if (!has.absolute) return "displacements only: unloaded absolute positions or circle sweeps of all axes are needed";
  return {};
}

}  // namespace

const EffectRecord& kinematicError() {
  static const EffectRecord record{
      .effect = Effect::kinematic_error, .nature = EffectNature::geometry, .missing = &kinematicErrorMissing};
  return record;
}

}  // namespace stiffscope::effects
