#include "core/effects/all.h"

#include "core/effects/backlash.h"
#include "core/effects/base_compliance.h"
#include "core/effects/bearing_tilt.h"
#include "core/effects/frame_error.h"
#include "core/effects/gravity_compensator.h"
#include "core/effects/hysteresis.h"
#include "core/effects/joint_coupling.h"
#include "core/effects/joint_hardening.h"
#include "core/effects/link_compliance.h"
#include "core/effects/load_cell_bias.h"
#include "core/effects/load_cell_misalignment.h"
#include "core/effects/load_point_error.h"
#include "core/effects/target_motion.h"
#include "core/effects/tool_compliance.h"
#include "core/effects/tracker_drift.h"

namespace stiffscope::effects {

std::vector<EffectModel> effectModels(const std::vector<std::string>& targets) {
  return {
      linkCompliance(),
      bearingTilt(),
      baseCompliance(),
      jointCoupling(),
      jointHardening(),
      jointHardeningLinear(),
      jointHardeningCubicSpring(),
      jointHardeningWhole(),
      jointHardeningLinearWhole(),
      jointHardeningByStages(),
      jointHardeningSmooth(),
      backlash(),
      hysteresis(),
      hysteresisOneSlider(),
      hysteresisManySliders(),
      gravityCompensator(),
      loadPointError(),
      loadCellMisalignment(),
      loadCellBias(),
      loadCellMissingWeight(),
      frameError(),
      trackerDrift(),
      targetMotion(targets),
      targetSlip(targets),
      targetLastingSlip(targets),
      targetSlipFromHalf(targets),
      targetSlipAtFull(targets),
      targetNestSpring(targets),
      targetPulledAlong(targets),
      toolCompliance(),
      toolComplianceByLoad(),
  };
}

std::vector<EffectModel> effectModelsOf(const campaign::Campaign& campaign) {
  std::vector<std::string> targets;
  for (const campaign::Target& target : campaign.targets) targets.push_back(target.id);
  return effectModels(targets);
}

}  // namespace stiffscope::effects
