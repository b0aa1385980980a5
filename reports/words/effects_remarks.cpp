#include "core/effects/remarks.h"
#include "reports/words/remarks.h"

namespace stiffscope::reports {

std::string effectsWords(effects::RemarkId id, const RemarkValues&) {
  using enum effects::RemarkId;
  switch (id) {
    case backlash_needs_loads_or_masses:
      return "one load step and no masses: lost motion needs torques that pass zero, from two or more loads";
    case bias_needs_two_loads:
      return "one load step: a constant part of the force needs two or more loads of different size";
    case compensator_needs_masses:
      return "the masses of the links are not known: the spring cannot be told from the own weight";
    case compensator_needs_positions:
      return "displacements only: unloaded absolute positions against forward kinematics are needed";
    case drift_needs_nests_or_timed_positions:
      return "no floor nests and no absolute positions with times: read three nests before, during and after";
    case frame_needs_masses_or_nests:
      return "the masses of the links are not known: the sag in absolute positions hides it; state them, or read nests";
    case frame_needs_sweeps_and_positions:
      return "needs circle sweeps and absolute unloaded positions in the same frame of the tracker";
    case geometry_needs_masses:
      return "the masses of the links are not known: the sag cannot be told from geometry";
    case geometry_needs_positions:
      return "displacements only: unloaded absolute positions or circle sweeps of all axes are needed";
    case hardening_needs_two_loads:
      return "one load step: two or more loads of different size in each posture are needed";
    case hysteresis_needs_return_to_zero:
      return "no return to zero: a last, unloaded step in each posture is needed";
    case rail_bending_needs_rail:
      return "the arm stands on no rail: the URDF has no prismatic joint before the arm's joints";
    case rail_bending_needs_three_positions:
      return "fewer than three positions of the carriage under load: where a rail gives more shows only against others";
    case target_needs_three_reflectors:
      return "fewer than three reflectors: one that moves shows only against two others";
    case tool_needs_reflectors_or_moments:
      return "one reflector at the loaded point: more reflectors, and moments, on the tool are needed";
  }
  return {};
}

}  // namespace stiffscope::reports
