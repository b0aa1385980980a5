#include "core/improved/effect_nature.h"

namespace stiffscope {

EffectNature natureOf(Effect effect) {
  switch (effect) {
    case Effect::link_compliance:
    case Effect::bearing_tilt:
    case Effect::base_compliance:
    case Effect::joint_coupling:
    case Effect::joint_hardening:
    case Effect::backlash:
    case Effect::hysteresis:
    case Effect::gravity_compensator:
    case Effect::tool_compliance:
      return EffectNature::machine;
    case Effect::load_point_error:
      return EffectNature::load;
    case Effect::load_cell_misalignment:
    case Effect::load_cell_bias:
    case Effect::frame_error:
    case Effect::tracker_drift:
    case Effect::target_motion:
      return EffectNature::measurement;
    case Effect::kinematic_error:
      return EffectNature::geometry;
  }
  return EffectNature::measurement;
}

bool entersCompensation(Effect effect) {
  return natureOf(effect) == EffectNature::machine || natureOf(effect) == EffectNature::load;
}

std::string useOf(Effect effect) {
  switch (effect) {
    case Effect::hysteresis:
      return "the machine does it: taken off the readings and added to predicted deflections, for a load that is "
             "put on once, from none";
    case Effect::tool_compliance:
      return "the machine does it: taken off the readings and added to predicted deflections, of the tool beyond "
             "the plate";
    case Effect::load_cell_misalignment:
    case Effect::load_cell_bias:
      return "a fault of the measured wrenches: these are corrected; a planned load is taken as it is stated";
    case Effect::frame_error:
      return "a fault of the measurement: the loading's readings are brought back into the sweeps' frame; no part of "
             "a deflection";
    case Effect::tracker_drift:
      return "a fault of the measurement: taken off the readings; no part of a deflection";
    case Effect::target_motion:
      return "a fault of the measurement: taken off that reflector's readings; the flange does not do it";
    default:
      break;
  }
  switch (natureOf(effect)) {
    case EffectNature::load:
      return "the load acts elsewhere than declared: the point is corrected, for planned loads too";
    case EffectNature::geometry:
      return "every identification has the geometry of the sweeps or calibrates it: nothing is added";
    default:
      return "the machine does it: taken off the readings and added to predicted deflections";
  }
}

}  // namespace stiffscope
