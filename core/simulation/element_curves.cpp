#include "core/simulation/element_curves.h"

namespace stiffscope::simulation {

TorqueCurve jointCurve(const JointStiffness& joint) {
  TorqueCurve curve;
  curve.cubic = joint.cubic;
  if (joint.stages || joint.backlash) {
    curve.positive = joint.stages ? stagesByTorque(joint.stages->torques, joint.stages->rates)
                                  : std::vector{TorqueCurve::Stage{*joint.torsion}};
    if (joint.backlash) {
      const double half = 0.5 * joint.backlash->width;
      const double rate = joint.backlash->rest * curve.positive.front().rate;
      for (TorqueCurve::Stage& stage : curve.positive) stage.until += half;
      curve.positive.insert(curve.positive.begin(), {rate, half});
    }
    curve.negative = curve.positive;
  }
  if (joint.friction) {
    const int count = joint.friction->sliders;
    for (int s = 1; s <= count; ++s) {
      curve.sliders.push_back(
          {joint.friction->rate / count, joint.friction->torque * 2.0 * s / (count * (count + 1.0))});
    }
  }
  return curve;
}

TorqueCurve contactCurve(const OneSidedContact& contact) {
  TorqueCurve curve;
  (contact.positive ? curve.positive : curve.negative) = {{0.0, contact.gap}, {contact.stiffness}};
  return curve;
}

}  // namespace stiffscope::simulation
