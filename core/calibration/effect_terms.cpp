#include "core/calibration/effect_terms.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "core/effects/effect.h"
#include "core/numerics/resampling.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::calibration {

namespace {

using Angles = std::function<JointVector(const Posture&)>;
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
    JointVector angles = JointVector::Zero(posture.q.size());
    angles[joint] = of(posture);
    return angles;
  };
}

// More is no error but another machine.
constexpr double kMostJointError = 0.01, kMostTurn = 0.1, kMostShift = 0.1;  // rad, rad, m
constexpr double kMostLag = 0.1;                                             // of a move

/// Six terms of a small motion of all reflectors, scaled by a number of the posture.
template <class Of>
std::vector<EffectTerm> rigidMotion(Of of, const std::string& when) {
  static constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  std::vector<EffectTerm> terms;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
    terms.push_back(moving(fmt::format("turn about {}{}", kAxes[static_cast<std::size_t>(k)], when), "rad", kMostTurn,
                           [axis, of](const Posture& posture, const ReflectorAt& at) -> Eigen::Vector3d {
                             return of(posture) * axis.cross(at.position);
                           }));
  }
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
    terms.push_back(moving(
        fmt::format("shift along {}{}", kAxes[static_cast<std::size_t>(k)], when), "m", kMostShift,
        [axis, of](const Posture& posture, const ReflectorAt&) -> Eigen::Vector3d { return of(posture) * axis; }));
  }
  return terms;
}

constexpr double kMostCompliance = 1e-3;  // rad/Nm: a joint of 1000 Nm/rad, softer than any arm's

}  // namespace

std::vector<EffectPart> jointCompliances(const UnloadedDay& day) {
  std::vector<EffectPart> parts;
  if (!day.masses_known) return parts;
  for (int j = 0; j < day.arm.joints(); ++j) {
    EffectTerm term = turning(jointName(j), "rad/Nm", kMostCompliance,
                              onJoint(j, [j](const Posture& posture) { return posture.torque[j]; }));
    term.positive = true;
    term.compliance_of = j;
    parts.push_back({UnloadedEffect::joint_compliance, jointName(j), {std::move(term)}});
  }
  return parts;
}

EffectPart transmissionError(int joint, double order) {
  const auto term = [&](const char* name, auto function) {
    return turning(fmt::format("{} of {:g} q{}", name, order, joint + 1), "rad", kMostJointError,
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

namespace {

UnloadedEffect effectOf(const BendingTerm& of) {
  switch (static_cast<effects::Effect>(of.effect)) {
    case effects::Effect::link_compliance:
      return UnloadedEffect::link_compliance;
    case effects::Effect::bearing_tilt:
      return UnloadedEffect::bearing_tilt;
    default:
      return UnloadedEffect::base_compliance;
  }
}

/// Links, bearings and base, as the loaded days have them.
std::vector<EffectPart> bendingCompliances(const UnloadedDay& day, UnloadedEffect effect) {
  std::vector<EffectPart> parts;
  for (std::size_t k = 0; k < day.bending.size(); ++k) {
    const BendingTerm& of = day.bending[k];
    if (effectOf(of) != effect) continue;
    EffectTerm term =
        moving(of.name, of.unit, of.most, [k](const Posture& posture, const ReflectorAt& at) -> Eigen::Vector3d {
          return posture.bends[k].at(at.position);
        });
    term.positive = !of.coupling;
    parts.push_back({effect, of.detail, {std::move(term)}});
  }
  return parts;
}

/// The terms of all parts at once.
EffectPart wholeOf(UnloadedEffect effect, const std::vector<EffectPart>& parts) {
  EffectPart whole{effect, "", {}};
  for (const EffectPart& part : parts) whole.terms.insert(whole.terms.end(), part.terms.begin(), part.terms.end());
  return whole;
}

/// Joints that twist under weights that nobody states: compliance times moment, a part a joint.
std::vector<EffectPart> freeMomentTwists(const UnloadedDay& day) {
  constexpr double kMost = 1e-3;  // rad/(m/s^2): a hundredth of a radian by gravity
  std::vector<EffectPart> parts;
  for (int j = 0; j < day.arm.joints(); ++j) {
    EffectPart part{UnloadedEffect::joint_compliance, jointName(j), {}};
    for (std::size_t k = 0; k < day.free_moments.size(); ++k) {
      const FreeMoment& of = day.free_moments[k];
      if (of.joint != j) continue;
      Eigen::Index axis = 0;
      of.along.maxCoeff(&axis);
      part.terms.push_back(turning(fmt::format("{} times moment {} of body {}", jointName(j), "xyz"[axis], of.body + 1),
                                   "rad/(m/s^2)", kMost,
                                   onJoint(j, [k](const Posture& posture) { return posture.pulls[k]; })));
    }
    if (!part.terms.empty()) parts.push_back(std::move(part));
  }
  return parts;
}

EffectFamily compliances(UnloadedEffect effect, std::vector<EffectPart> parts) {
  EffectFamily family{effect, std::move(parts), {}};
  if (family.parts.size() > 1) family.wholes.push_back(wholeOf(effect, family.parts));
  return family;
}

/// A coupling alone is no compliance: it stands in wholes, with the two that it couples and with all.
EffectFamily bendingFamily(const UnloadedDay& day, UnloadedEffect effect) {
  EffectFamily family = compliances(effect, bendingCompliances(day, effect));
  const auto couples = [](const EffectPart& part) { return !part.terms.front().positive; };
  std::vector<EffectPart> turns;
  for (const EffectPart& part : family.parts) {
    if (part.terms.front().unit == "rad/Nm") turns.push_back(part);
  }
  const bool coupled = std::any_of(turns.begin(), turns.end(), couples);
  if (coupled) family.wholes.push_back(wholeOf(effect, turns));
  std::erase_if(family.parts, couples);
  return family;
}

/// A spring or cylinder on axis 2 beside the own weight on all joints: its torque is a function of the angle of joint
/// 2, of which the first two harmonics are taken.
EffectFamily gravityCompensator(const std::vector<EffectPart>& compliances) {
  EffectFamily family{UnloadedEffect::gravity_compensator};
  EffectPart whole = wholeOf(family.effect, compliances);
  whole.needs_compliance_of = 1;
  for (const double harmonic : {1.0, 2.0}) {
    const EffectPart wave = transmissionError(1, harmonic);
    whole.terms.insert(whole.terms.end(), wave.terms.begin(), wave.terms.end());
    family.wholes.push_back(whole);
  }
  return family;
}

/// Legendre's polynomials of the time of the day, from -1 to 1.
double legendre(int degree, const Posture& posture) {
  return std::legendre(static_cast<unsigned>(degree), 2.0 * posture.time - 1.0);
}

/// Forms of what wanders over the day: polynomials up to the first, the second .. sixth degree. `terms_of(f)`: of what
/// follows a function of the posture.
template <class TermsOf>
std::vector<EffectPart> wandering(UnloadedEffect effect, const TermsOf& terms_of) {
  constexpr int kDegrees = 6;
  std::vector<EffectPart> wholes;
  EffectPart whole{effect, "", {}};
  for (int degree = 1; degree <= kDegrees; ++degree) {
    const auto more = terms_of([degree](const Posture& posture) { return legendre(degree, posture); },
                               fmt::format(" over the day, degree {}", degree));
    whole.terms.insert(whole.terms.end(), more.begin(), more.end());
    wholes.push_back(whole);
  }
  return wholes;
}

/// Forms of what grows over the day, in one way only: steadily, or towards a limit.
template <class TermsOf>
std::vector<EffectPart> growing(UnloadedEffect effect, const TermsOf& terms_of) {
  std::vector<EffectPart> forms;
  forms.push_back({effect, "", terms_of([](const Posture& posture) { return posture.time; }, " over the day")});
  for (const double constant : {0.5, 0.25, 0.12}) {
    const auto towards = [constant](const Posture& posture) { return 1.0 - std::exp(-posture.time / constant); };
    forms.push_back(
        {effect, "", terms_of(towards, fmt::format(" towards a limit, time constant {:g} of the day", constant))});
  }
  return forms;
}

constexpr double kMostGrowth = 1e-2;

template <class Of>
std::vector<EffectTerm> growth(Of of, const std::string& when) {
  return {moving(
      "growth" + when, "m/m", kMostGrowth,
      [of](const Posture& posture, const ReflectorAt& at) -> Eigen::Vector3d { return of(posture) * at.position; })};
}

template <class Of>
std::vector<EffectTerm> scaling(Of of, const std::string& when) {
  return {moving("scale" + when, "m/m", kMostGrowth,
                 [of](const Posture& posture, const ReflectorAt& at) -> Eigen::Vector3d {
                   return of(posture) * (at.position - at.station);
                 })};
}

/// From axis to axis: the links' directions with all joints at zero, as long as the links are.
PerJoint<Eigen::Vector3d> linksAtZero(const UnloadedDay& day) {
  PerJoint<Eigen::Vector3d> links(day.arm.axes_in_base_at_zero.size() - 1);
  for (std::size_t i = 0; i < links.size(); ++i)
    links[i] = day.arm.axes_in_base_at_zero[i + 1].point - day.arm.axes_in_base_at_zero[i].point;
  return links;
}

/// Some links grow, each in proportion to its length; what they carry moves along.
template <class Of>
std::vector<EffectTerm> linksGrow(const UnloadedDay& day, std::vector<std::size_t> which, Of of,
                                  const std::string& name) {
  const auto links = linksAtZero(day);
  return {moving(name, "m/m", kMostGrowth,
                 [links, which = std::move(which), of](const Posture& posture, const ReflectorAt& at) {
                   Eigen::Vector3d offset = Eigen::Vector3d::Zero();
                   for (const std::size_t i : which) offset += at.arm.turnOf(i + 1) * links[i];
                   return Eigen::Vector3d(of(posture) * offset);
                 })};
}

/// All lengths from the base to the reflectors, the arm's links without the tool, or single links.
EffectFamily thermalGrowth(const UnloadedDay& day) {
  EffectFamily family{UnloadedEffect::thermal_growth};
  const UnloadedEffect effect = family.effect;
  const auto addAll = [](std::vector<EffectPart> more, std::vector<EffectPart>& to) {
    to.insert(to.end(), more.begin(), more.end());
  };
  const auto warmth = [](const Posture& posture) { return posture.warmth; };
  if (day.temperature_known) family.wholes.push_back({effect, "", growth(warmth, " by temperature, a kelvin")});
  addAll(growing(effect, [](auto of, const std::string& when) { return growth(of, when); }), family.wholes);
  const auto links = linksAtZero(day);
  std::vector<std::size_t> all;
  constexpr double kShort = 1e-3;  // m: two axes at one place are no link
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].norm() > kShort) all.push_back(i);
  }
  const auto addLinks = [&](const std::vector<std::size_t>& which, const std::string& name,
                            std::vector<EffectPart>& to) {
    if (day.temperature_known)
      to.push_back({effect, "", linksGrow(day, which, warmth, "growth of " + name + " by temperature, a kelvin")});
    addAll(
        growing(effect, [&](auto of,
                            const std::string& when) { return linksGrow(day, which, of, "growth of " + name + when); }),
        to);
  };
  addLinks(all, "the links", family.wholes);
  for (const std::size_t i : all) addLinks({i}, fmt::format("link {}", i + 1), family.parts);
  return family;
}

std::vector<EffectPart> ratioErrors(int joints) {
  std::vector<EffectPart> parts;
  constexpr double kMostShare = 0.1;
  const int wrist = robot::armJointsOf(joints);  // its first joint, from 0
  for (int j = 0; j < joints; ++j) {
    for (int of = 0; of < joints; ++of) {
      // A share of the next joint out or in, or of any other of the wrist: gears and parallelograms join these.
      if (std::abs(of - j) > 1 && std::min(of, j) < wrist) continue;
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

EffectFamily backlash(const UnloadedDay& day) {
  EffectFamily family{UnloadedEffect::backlash};
  const int joints = day.arm.joints();
  for (int j = 0; j < joints; ++j) {
    family.parts.push_back({family.effect,
                            jointName(j),
                            {turning(jointName(j), "rad", kMostJointError,
                                     onJoint(j, [j](const Posture& posture) { return posture.side[j]; }))}});
  }
  for (EffectPart& part : family.parts) part.tried = joints;
  family.wholes.push_back(wholeOf(family.effect, family.parts));
  // Where more than its friction pulls on a joint the play stands on the side of the pull, wherever it came from. What
  // the friction is nobody says: shares of the day's postures stand on either side of it.
  for (int j = 0; day.masses_known && j < joints; ++j) {
    std::vector<double> pulls;
    for (const Posture& posture : day.postures) pulls.push_back(std::abs(posture.torque[j]));
    std::sort(pulls.begin(), pulls.end());
    if (pulls.empty() || pulls.back() <= 0.0) continue;
    for (const double share : {0.0, 0.25, 0.5, 0.75}) {
      const double friction = share > 0.0 ? numerics::quantile(pulls, share) : 0.0;
      const auto stands = [j, friction](const Posture& posture) {
        const double pull = posture.torque[j];
        return std::abs(pull) > friction ? (pull > 0.0 ? 1.0 : -1.0) : -posture.side[j];
      };
      EffectTerm term = turning(fmt::format("{}, weight of more than {:.3g} Nm pulling", jointName(j), friction), "rad",
                                kMostJointError, onJoint(j, stands));
      term.positive = true;
      family.parts.push_back({family.effect, jointName(j), {std::move(term)}});
    }
  }
  return family;
}

EffectFamily readBackError(int joints) {
  EffectFamily family{UnloadedEffect::read_back_error};
  family.wholes.push_back(
      {family.effect, "", {turning("share of the last move", "rad/rad", kMostLag, [](const Posture& posture) {
         return posture.move;
       })}});
  EffectPart by_joint{family.effect, "", {}};
  for (int j = 0; j < joints; ++j) {
    by_joint.terms.push_back(turning("share of the last move of " + jointName(j), "rad/rad", kMostLag,
                                     onJoint(j, [j](const Posture& posture) { return posture.move[j]; })));
  }
  family.wholes.push_back(std::move(by_joint));
  return family;
}

}  // namespace

std::vector<EffectTerm> stationPoses(const UnloadedDay& day, const Eigen::Isometry3d& base_from_points) {
  std::vector<EffectTerm> terms;
  for (std::size_t s = 0; s < day.stations.size(); ++s) {
    const campaign::StationPlace& station = day.stations[s];
    if (station.covariance.isZero()) continue;  // the first: the others stand against it
    const Eigen::MatrixXd root = covarianceRoot(station.covariance);
    const Eigen::Vector3d centre = base_from_points * station.centre;
    for (Eigen::Index k = 0; k < root.cols(); ++k) {
      const Eigen::Vector3d turn = base_from_points.linear() * root.block<3, 1>(0, k),
                            shift = base_from_points.linear() * root.block<3, 1>(3, k);
      if (turn.isZero() && shift.isZero()) continue;
      constexpr double kOneSd = 1.0;
      terms.push_back(
          moving(fmt::format("pose of station {}, {}", station.id, k + 1), "", kOneSd,
                 [=, place = static_cast<int>(s)](const Posture&, const ReflectorAt& at) -> Eigen::Vector3d {
                   if (at.place != place) return Eigen::Vector3d::Zero();
                   return turn.cross(at.position - centre) + shift;
                 }));
    }
  }
  return terms;
}

EffectPart frameError(double from) {
  EffectPart part{UnloadedEffect::frame_error, "",
                  rigidMotion([from](const Posture& posture) { return posture.time >= from ? 1.0 : 0.0; }, "")};
  part.from = from;
  return part;
}

EffectPart scaleError(double from) {
  EffectPart part{UnloadedEffect::scale_error, "",
                  scaling([from](const Posture& posture) { return posture.time >= from ? 1.0 : 0.0; }, "")};
  part.from = from;
  return part;
}

EffectPart targetMotion(const UnloadedDay& day, int target, double from) {
  EffectPart part{UnloadedEffect::target_motion, day.targets[static_cast<std::size_t>(target)], {}};
  // Along the flange's own axes, in which the places of reflectors are stated.
  const Eigen::Matrix3d base_from_flange_at_zero = day.arm.base_from_flange_at_zero.linear();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = base_from_flange_at_zero.col(k);
    part.terms.push_back(moving(fmt::format("{} {}, in flange axes", part.detail, "xyz"[k]), "m", kMostShift,
                                [=](const Posture& posture, const ReflectorAt& at) -> Eigen::Vector3d {
                                  if (at.target != target || posture.time < from) return Eigen::Vector3d::Zero();
                                  return at.arm.byTarget() * axis;
                                }));
  }
  part.from = from;
  return part;
}

std::vector<EffectFamily> effectFamilies(const UnloadedDay& day) {
  const std::vector<EffectPart> twists = jointCompliances(day);
  std::vector<EffectFamily> families{
      compliances(UnloadedEffect::joint_compliance, day.masses_known ? twists : freeMomentTwists(day))};
  for (const UnloadedEffect effect :
       {UnloadedEffect::link_compliance, UnloadedEffect::bearing_tilt, UnloadedEffect::base_compliance})
    families.push_back(bendingFamily(day, effect));
  if (!twists.empty()) families.push_back(gravityCompensator(twists));
  families.push_back({UnloadedEffect::transmission_error});
  families.push_back({UnloadedEffect::ratio_error, ratioErrors(day.arm.joints()), {}});
  families.push_back(backlash(day));
  families.push_back(readBackError(day.arm.joints()));
  families.push_back({UnloadedEffect::tracker_drift,
                      {},
                      wandering(UnloadedEffect::tracker_drift,
                                [](auto of, const std::string& when) { return rigidMotion(of, when); })});
  families.push_back({UnloadedEffect::frame_error});
  families.push_back({UnloadedEffect::target_motion});
  families.push_back(thermalGrowth(day));
  families.push_back(
      {UnloadedEffect::scale_error, {}, growing(UnloadedEffect::scale_error, [](auto of, const std::string& when) {
         return scaling(of, when);
       })});
  std::erase_if(families, [](const EffectFamily& family) {
    const bool scanned = family.effect == UnloadedEffect::transmission_error ||
                         family.effect == UnloadedEffect::frame_error || family.effect == UnloadedEffect::target_motion;
    return !scanned && family.parts.empty() && family.wholes.empty();
  });
  return families;
}

}  // namespace stiffscope::calibration
