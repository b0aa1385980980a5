#include "core/effects/effect_model.h"

#include <array>
#include <fmt/format.h>

namespace stiffscope::effects {

std::vector<EffectPart> jointParts(double most, bool positive, const std::string& unit) {
  std::vector<EffectPart> parts;
  for (int j = 1; j <= 6; ++j) parts.push_back({fmt::format("joint {}", j), {most}, positive, unit});
  return parts;
}

Eigen::VectorXd bySprings(const WorkingPoint& at, const ArmState& state, const robot::Wrench& change) {
  Vector6d torque;
  for (int j = 0; j < 6; ++j) {
    const metrology::Line& axis = state.axes[static_cast<std::size_t>(j)];
    torque[j] = axis.direction.dot(change.about(axis.point).moment);
  }
  return byJoints(state, at.compliance.cwiseProduct(torque));
}

namespace {

constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
constexpr std::array<const char*, 6> kMotion{"turn about x", "turn about y", "turn about z",
                                             "shift along x", "shift along y", "shift along z"};
constexpr std::array<const char*, 6> kSymmetric{"xx", "yy", "zz", "xy", "xz", "yz"};

std::string entryName(const EffectModel& model, std::size_t count, std::size_t k) {
  switch (model.effect) {
    case Effect::link_compliance:
      return k == 0 ? "1/EI" : "1/GJ";
    case Effect::gravity_compensator:
      return fmt::format("{} {} q2", k % 2 == 0 ? "sin" : "cos", k / 2 + 1);
    case Effect::frame_error:
    case Effect::tracker_drift:
      return kMotion[k];
    case Effect::load_cell_misalignment:
      return fmt::format("turn about {}", kAxes[k]);
    default:
      break;
  }
  if (count == 6) return kSymmetric[k];
  return count == 3 ? kAxes[k] : "";
}

}  // namespace

std::string parameterName(const EffectModel& model, const EffectPart& part, std::size_t k) {
  const std::string entry = part.most.size() > 1 ? entryName(model, part.most.size(), k) : "";
  if (part.detail.empty()) return entry;
  if (entry.empty()) return part.detail;
  return model.effect == Effect::link_compliance ? entry + " of " + part.detail : part.detail + " " + entry;
}

std::string parameterUnit(const EffectPart& part, std::size_t k) {
  if (part.unit == "rad, m") return k < 3 ? "rad" : "m";
  return part.unit;
}

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

}  // namespace stiffscope::effects
