#include <algorithm>
#include <cmath>

#include "core/simulation/machine.h"

namespace stiffscope::simulation {

namespace {

double waveAt(const JointWave& wave, double q) { return wave.amplitude * std::sin(wave.cycles * q + wave.phase); }

/// 1 - exp(-t / tau): how far a slow change has come.
double comeSoFar(double time_s, double time_constant) { return -std::expm1(-time_s / time_constant); }

void scaleTorsion(ElasticMachine& machine, int joint, double factor) {
  const int axis = machine.nominal.axes_in_base_at_zero.axisOf(joint);
  for (ElasticElement& element : machine.elements) {
    if (element.axis == axis && !element.is_link) element.stiffness(5, 5) *= factor;
  }
  for (CoordinateCurve& one : machine.curves) {
    if (one.joint != joint) continue;
    one.curve.cubic *= factor;
    for (auto* side : {&one.curve.positive, &one.curve.negative}) {
      for (TorqueCurve::Stage& stage : *side) stage.rate *= factor;
    }
  }
}

/// True motor angle less reported, beyond the joint's zero.
double angleError(const JointStiffness& joint, const std::optional<TemperatureCourse>& temperature, int index,
                  const JointVector& q, double time_s) {
  double error = 0.0;
  if (joint.angle_wave) error += waveAt(*joint.angle_wave, q[index]);
  if (joint.ratio) error += joint.ratio->share * q[joint.ratio->of];
  if (joint.zero_jump && time_s >= joint.zero_jump->from_s) error += joint.zero_jump->angle;
  if (joint.zero_warming && temperature) {
    error +=
        joint.zero_warming->per_kelvin * (temperature->lagged(time_s, joint.zero_warming->lag) - temperature->at(0.0));
  }
  return error;
}

}  // namespace

bool ElasticMachine::changes() const {
  return rail_beam || !truth.growths.empty() ||
         std::any_of(truth.joints.begin(), truth.joints.end(), [](const auto& one) {
           return one.rate_wave || one.angle_wave || one.softening || one.ratio || one.zero_jump || one.zero_warming;
         });
}

ElasticMachine machineAt(const ElasticMachine& machine, const JointVector& q, double time_s) {
  using namespace simulation;
  ElasticMachine now = machine;
  for (int i = 0; i < machine.joints(); ++i) {
    const JointStiffness& joint = machine.truth.joints[static_cast<std::size_t>(i)];
    now.turnMotor(i, angleError(joint, machine.temperature, i, q, time_s));
    double factor = 1.0;
    if (joint.rate_wave) factor *= 1.0 + waveAt(*joint.rate_wave, q[i]);
    if (joint.softening) {
      factor *= 1.0 - joint.softening->share * comeSoFar(time_s, joint.softening->time_constant);
    }
    if (factor != 1.0) scaleTorsion(now, i, factor);
  }
  for (const ThermalGrowth& growth : machine.truth.growths) {
    const auto& axes = machine.nominal.axes_in_base_at_zero;
    const auto axis = static_cast<std::size_t>(axes.axisOf(growth.joint));
    const Eigen::Vector3d along = (axes[axis + 1].point - axes[axis].point).normalized();
    double longer = growth.growth * comeSoFar(time_s, growth.time_constant);
    if (machine.temperature)
      longer += growth.per_kelvin * (machine.temperature->at(time_s) - machine.temperature->at(0.0));
    now.axis_errors[axis + 1] = Eigen::Translation3d(longer * along) * now.axis_errors[axis + 1];
  }
  return now;
}

}  // namespace stiffscope::simulation
