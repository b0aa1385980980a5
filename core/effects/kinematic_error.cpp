#include "core/effects/all.h"

namespace stiffscope::effects {

// Lengths or joint zeros differ from the nominal geometry. It has no columns: the geometry is a nuisance of
// every fit, and what the fit finds is held against the nominal one (core/diagnosis/geometry_error.h).

namespace {

Remark kinematicErrorMissing(const CampaignContents& has) {
  if (!has.weights) return Remark(RemarkId::geometry_needs_masses);
  if (!has.absolute) return Remark(RemarkId::geometry_needs_positions);
  return {};
}

}  // namespace

const EffectRecord& kinematicError() {
  static const EffectRecord record{
      .effect = Effect::kinematic_error, .nature = EffectNature::geometry, .missing = &kinematicErrorMissing};
  return record;
}

}  // namespace stiffscope::effects
