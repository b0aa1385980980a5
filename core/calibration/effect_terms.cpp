#include "core/calibration/effect_terms.h"

#include <fmt/format.h>
#include <cmath>

#include "core/effects/effect.h"

namespace stiffscope::calibration {

namespace {

using Angles = std::function<Vector6d(const Posture&)>;
using Offset = std::function<Eigen::Vector3d(const Posture&, const ReflectorAt&)>;

EffectTerm turning(std::string name, std::string unit, double most, Angles angles) {
  return {.name = std::move(name), .unit = std::move(unit), .most = most, .angles = std::move(angles)};
}

EffectTerm moving(std::string name, std::string unit, double most, Offset offset) {
  return {.name = std::move(name), .unit = std::move(unit), .most = most, .offset = std::move(offset)};
}

std::string jointName(int joint) { return fmt::format("joint {}", joint + 1); }

/// A function of the posture on one joint alone.
template <class Of>
Angles onJoint(int joint, Of of) {
  return [joint, of](const Posture& posture) {
    Vector6d angles = Vector6d::Zero();
    angles[joint] = of(posture);
    return angles;
  };
}

constexpr double kMostTurn = 0.1, kMostShift = 0.1;  // rad, m: more is no error but another machine

/// Six terms of a small motion of all reflectors, scaled by a number of the posture.
template <class Of>
std::vector<EffectTerm> rigidMotion(Of of) {
  static constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  std::vector<EffectTerm> terms;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
    terms.push_back(moving(fmt::format("turn about {}", kAxes[static_cast<std::size_t>(k)]), "rad", kMostTurn,
                           [axis, of](const Posture& posture, const ReflectorAt& at) -> Eigen::Vector3d {
                             return of(posture) * axis.cross(at.position);
                           }));
  }
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
    terms.push_back(moving(
        fmt::format("shift along {}", kAxes[static_cast<std::size_t>(k)]), "m", kMostShift,
        [axis, of](const Posture& posture, const ReflectorAt&) -> Eigen::Vector3d { return of(posture) * axis; }));
  }
  return terms;
}

constexpr double kMostCompliance = 1e-3;  // rad/Nm: a joint of 1000 Nm/rad, softer than any arm's

}  // namespace

std::vector<EffectPart> jointCompliances(const UnloadedDay& day) {
  std::vector<EffectPart> parts;
  if (!day.masses_known) return parts;
  for (int j = 0; j < 6; ++j) {
    EffectTerm term = turning(jointName(j), "rad/Nm", kMostCompliance,
                              onJoint(j, [j](const Posture& posture) { return posture.torque[j]; }));
    term.positive = true;
    parts.push_back({UnloadedEffect::joint_compliance, jointName(j), {std::move(term)}});
  }
  return parts;
}

std::vector<EffectPart> bendingCompliances(const UnloadedDay& day) {
  std::vector<EffectPart> parts;
  for (std::size_t k = 0; k < day.bending.size(); ++k) {
    const BendingTerm& of = day.bending[k];
    EffectTerm term =
        moving(of.name, of.unit, of.most, [k](const Posture& posture, const ReflectorAt& at) -> Eigen::Vector3d {
          return posture.bends[k].at(at.position);
        });
    term.positive = true;
    const UnloadedEffect effect =
        of.effect == static_cast<std::size_t>(effects::Effect::link_compliance) ? UnloadedEffect::link_compliance
        : of.effect == static_cast<std::size_t>(effects::Effect::bearing_tilt)  ? UnloadedEffect::bearing_tilt
                                                                                : UnloadedEffect::base_compliance;
    parts.push_back({effect, of.detail, {std::move(term)}});
  }
  return parts;
}

EffectPart transmissionError(int joint, double order) {
  const auto term = [&](const char* name, auto function) {
    return turning(fmt::format("{} of {:g} q{}", name, order, joint + 1), "rad", kMostTurn,
                   onJoint(joint, [joint, order, function](const Posture& posture) {
                     return function(order * posture.q[joint]);
                   }));
  };
  EffectPart part{UnloadedEffect::transmission_error, jointName(joint), {}};
  part.terms.push_back(term("sin", [](double angle) { return std::sin(angle); }));
  part.terms.push_back(term("cos", [](double angle) { return std::cos(angle); }));
  part.order = order;
  return part;
}

std::vector<EffectPart> ratioErrors() {
  std::vector<EffectPart> parts;
  constexpr double kMostShare = 0.1;
  for (int j = 0; j < 6; ++j) {
    for (int of = 0; of < 6; ++of) {
      // A share of the next joint out or in: wrist gears and parallelograms join neighbours.
      if (std::abs(of - j) > 1) continue;
      const std::string detail =
          of == j ? jointName(j) : fmt::format("joints {} and {}", std::min(of, j) + 1, std::max(of, j) + 1);
      parts.push_back({UnloadedEffect::ratio_error,
                       detail,
                       {turning(fmt::format("joint {} by the angle of joint {}", j + 1, of + 1), "rad/rad", kMostShare,
                                onJoint(j, [of](const Posture& posture) { return posture.q[of]; }))}});
    }
  }
  return parts;
}

std::vector<EffectPart> backlashes() {
  std::vector<EffectPart> parts;
  for (int j = 0; j < 6; ++j) {
    parts.push_back({UnloadedEffect::backlash,
                     jointName(j),
                     {turning(jointName(j), "rad", kMostTurn,
                              onJoint(j, [j](const Posture& posture) { return posture.side[j]; }))}});
  }
  return parts;
}

std::vector<EffectPart> readBackErrors() {
  return {
      {UnloadedEffect::read_back_error,
       "",
       {turning("share of the last move", "rad/rad", kMostTurn, [](const Posture& posture) { return posture.move; })}}};
}

std::vector<EffectPart> driftsOverTime(const UnloadedDay&) {
  const auto time = [](const Posture& posture) { return posture.time - 0.5; };
  constexpr double kMostGrowth = 1e-2;
  EffectPart drift{UnloadedEffect::tracker_drift, "", rigidMotion(time)};
  EffectPart growth{UnloadedEffect::thermal_growth,
                    "",
                    {moving("growth over the day", "m/m", kMostGrowth,
                            [time](const Posture& posture, const ReflectorAt& at) -> Eigen::Vector3d {
                              return time(posture) * at.position;
                            })}};
  EffectPart scale{UnloadedEffect::scale_error,
                   "",
                   {moving("scale over the day", "m/m", kMostGrowth,
                           [time](const Posture& posture, const ReflectorAt& at) -> Eigen::Vector3d {
                             return time(posture) * (at.position - at.station);
                           })}};
  return {drift, growth, scale};
}

EffectPart frameError(double from) {
  EffectPart part{UnloadedEffect::frame_error, "",
                  rigidMotion([from](const Posture& posture) { return posture.time >= from ? 1.0 : 0.0; })};
  part.from = from;
  return part;
}

EffectPart targetMotion(const UnloadedDay& day, int target, double from) {
  EffectPart part{UnloadedEffect::target_motion, day.targets[static_cast<std::size_t>(target)], {}};
  for (int k = 0; k < 3; ++k) {
    part.terms.push_back(moving(fmt::format("{} {}", part.detail, "xyz"[k]), "m", kMostShift,
                                [=](const Posture& posture, const ReflectorAt& at) -> Eigen::Vector3d {
                                  if (at.target != target || posture.time < from) return Eigen::Vector3d::Zero();
                                  return at.arm.byTarget().col(k);
                                }));
  }
  part.from = from;
  return part;
}

std::vector<EffectPart> fixedParts(const UnloadedDay& day) {
  std::vector<EffectPart> all;
  for (auto parts : {jointCompliances(day), bendingCompliances(day), ratioErrors(), backlashes(), readBackErrors(),
                     driftsOverTime(day)}) {
    all.insert(all.end(), parts.begin(), parts.end());
  }
  return all;
}

}  // namespace stiffscope::calibration
