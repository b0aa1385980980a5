#include "core/diagnosis/effect_table.h"

#include "core/diagnosis/effects/backlash.h"
#include "core/diagnosis/effects/base_compliance.h"
#include "core/diagnosis/effects/bearing_tilt.h"
#include "core/diagnosis/effects/frame_error.h"
#include "core/diagnosis/effects/gravity_compensator.h"
#include "core/diagnosis/effects/hysteresis.h"
#include "core/diagnosis/effects/joint_coupling.h"
#include "core/diagnosis/effects/joint_hardening.h"
#include "core/diagnosis/effects/link_compliance.h"
#include "core/diagnosis/effects/load_cell_bias.h"
#include "core/diagnosis/effects/load_cell_misalignment.h"
#include "core/diagnosis/effects/load_point_error.h"
#include "core/diagnosis/effects/target_motion.h"
#include "core/diagnosis/effects/tool_compliance.h"
#include "core/diagnosis/effects/tracker_drift.h"

namespace stiffscope {

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

std::vector<EffectModel> effectModelsOf(const Campaign& campaign) {
  std::vector<std::string> targets;
  for (const Target& target : campaign.targets) targets.push_back(target.id);
  return effectModels(targets);
}

}  // namespace stiffscope
