#include "core/diagnosis/testable.h"

#include <cmath>
#include <set>

namespace stiffscope {

CampaignHas whatIsThere(const GapInput& input, const GapData& data, const GapState& state, const Station& station) {
  CampaignHas has;
  has.absolute = input.absolute;
  has.sweeps = input.sweeps;
  has.nests = station.motion.tested;
  has.weights = state.geometry.weight.links_known;
  std::set<int> steps;
  for (const GapPosture& posture : data.postures) {
    has.reflectors = std::max(has.reflectors, posture.states.front().points.size());
    for (std::size_t s = 1; s < posture.states.size(); ++s) {
      const ArmState& one = posture.states[s];
      if (one.loaded) steps.insert(one.step);
      if (!one.loaded) has.return_to_zero = true;
      if (std::isfinite(one.time_s)) has.times = true;
    }
  }
  has.load_steps = steps.size();
  for (const State& row : input.campaign.states->rows) has.moments |= !row.wrench_in_cell.tail<3>().isZero();
  return has;
}

std::string missingFor(Effect effect, const CampaignHas& has) {
  switch (effect) {
    case Effect::joint_hardening:
      if (has.load_steps < 2) return "one load step: two or more loads of different size in each posture are needed";
      break;
    case Effect::load_cell_bias:
      if (has.load_steps < 2) return "one load step: a constant part of the force needs two or more loads of different size";
      break;
    case Effect::hysteresis:
      if (!has.return_to_zero) return "no return to zero: a last, unloaded step in each posture is needed";
      break;
    case Effect::backlash:
      if (has.load_steps < 2 && !has.weights)
        return "one load step and no masses: lost motion needs torques that pass zero, from two or more loads";
      break;
    case Effect::gravity_compensator:
      if (!has.absolute) return "displacements only: unloaded absolute positions against forward kinematics are needed";
      if (!has.weights) return "the masses of the links are not known: the spring cannot be told from the own weight";
      break;
    case Effect::frame_error:
      if (!has.absolute || !has.sweeps)
        return "needs circle sweeps and absolute unloaded positions in the same frame of the tracker";
      break;
    case Effect::kinematic_error:
      if (!has.absolute) return "displacements only: unloaded absolute positions or circle sweeps of all axes are needed";
      break;
    case Effect::tracker_drift:
      if (!has.nests && (!has.times || !has.absolute))
        return "no floor nests and no absolute positions with times: read three nests before, during and after";
      break;
    case Effect::target_motion:
      if (has.reflectors < 3) return "fewer than three reflectors: one that moves shows only against two others";
      break;
    case Effect::tool_compliance:
      if (has.reflectors < 2 && !has.moments)
        return "one reflector at the loaded point: more reflectors, and moments, on the tool are needed";
      break;
    case Effect::load_cell_misalignment:
    case Effect::load_point_error:
      break;
    default:
      break;
  }
  return {};
}

}  // namespace stiffscope
