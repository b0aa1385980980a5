#include "core/diagnosis/preconditions.h"

#include <cmath>
#include <set>

namespace stiffscope::diagnosis {

CampaignHas whatIsThere(const GapInput& input, const GapData& data, const GapState& state,
                        const preparation::DriftModel& station) {
  CampaignHas has;
  has.absolute = input.absolute;
  has.sweeps = input.sweeps;
  has.nests = station.motion.tested;
  has.weights = state.geometry.weight.links_known;
  std::set<int> steps;
  for (const GapPosture& posture : data.postures) {
    has.reflectors = std::max(has.reflectors, posture.states.front().points.size());
    for (std::size_t s = 1; s < posture.states.size(); ++s) {
      const effects::ArmState& one = posture.states[s];
      if (one.loaded) steps.insert(one.step);
      if (!one.loaded) has.return_to_zero = true;
      if (std::isfinite(one.time_s)) has.times = true;
    }
  }
  has.load_steps = steps.size();
  for (const campaign::State& row : input.campaign.states->rows) has.moments |= !row.wrench_in_cell.tail<3>().isZero();
  return has;
}

std::string missingFor(effects::Effect effect, const CampaignHas& has) {
  switch (effect) {
    case effects::Effect::joint_hardening:
      if (has.load_steps < 2)
        return "one load step: two or more loads of different size in each posture are needed";
      break;
    case effects::Effect::load_cell_bias:
      if (has.load_steps < 2)
        return "one load step: a constant part of the force needs two or more loads of different size";
      break;
    case effects::Effect::hysteresis:
      if (!has.return_to_zero) return "no return to zero: a last, unloaded step in each posture is needed";
      break;
    case effects::Effect::backlash:
      if (has.load_steps < 2 && !has.weights)
        return "one load step and no masses: lost motion needs torques that pass zero, from two or more "
               "loads";
      break;
    case effects::Effect::gravity_compensator:
      if (!has.weights)
        return "the masses of the links are not known: the spring cannot be told from the own weight";
      if (!has.absolute)
        return "displacements only: unloaded absolute positions against forward kinematics are needed";
      break;
    case effects::Effect::frame_error:
      if (!has.weights && !has.nests)
        return "the masses of the links are not known: the sag in absolute positions hides it; state them, "
               "or read nests";
      if (has.weights && (!has.absolute || !has.sweeps))
        return "needs circle sweeps and absolute unloaded positions in the same frame of the tracker";
      break;
    case effects::Effect::kinematic_error:
      if (!has.weights) return "the masses of the links are not known: the sag cannot be told from geometry";
      if (!has.absolute)
        return "displacements only: unloaded absolute positions or circle sweeps of all axes are needed";
      break;
    case effects::Effect::tracker_drift:
      if (!has.nests && (!has.times || !has.absolute))
        return "no floor nests and no absolute positions with times: read three nests before, during and "
               "after";
      break;
    case effects::Effect::target_motion:
      if (has.reflectors < 3)
        return "fewer than three reflectors: one that moves shows only against two others";
      break;
    case effects::Effect::tool_compliance:
      if (has.reflectors < 2 && !has.moments)
        return "one reflector at the loaded point: more reflectors, and moments, on the tool are needed";
      break;
    case effects::Effect::load_cell_misalignment:
    case effects::Effect::load_point_error:
      break;
    default:
      break;
  }
  return {};
}

}  // namespace stiffscope::diagnosis
