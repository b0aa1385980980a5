#include "bench/unloaded_causes.h"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace stiffscope::bench {

using calibration::UnloadedEffect;
using Eigen::Vector3d;

namespace {

Vector3d turned(const Vector3d& point, const Vector3d& about, const Vector3d& axis, double angle) {
  return about + Eigen::AngleAxisd(angle, axis) * (point - about);
}

/// By a rotation vector.
Vector3d turned(const Vector3d& point, const Vector3d& about, const Vector3d& rotation) {
  const double angle = rotation.norm();
  return angle > 0.0 ? turned(point, about, rotation / angle, angle) : point;
}

/// Joints off by `errors`: the outermost turns first, about where the axes stand as reported.
Vector3d turnedByJoints(const NominalPosture& posture, Vector3d point, const JointVector& errors) {
  for (std::size_t j = posture.axis.size(); j-- > 0;) {
    const double error = errors[static_cast<Eigen::Index>(j)];
    if (error != 0.0) point = turned(point, posture.on_axis[j], posture.axis[j], error);
  }
  return point;
}

/// Moment of everything beyond joint j (from 0) about a point, Nm.
Vector3d momentBeyond(const NominalDay& day, const NominalPosture& posture, std::size_t j, const Vector3d& about) {
  return (posture.weight_at[j] - about).cross(day.mass_beyond[j] * day.gravity);
}

Vector3d across(const Vector3d& vector, const Vector3d& axis) { return vector - axis * axis.dot(vector); }

/// A random entry of those given.
template <class Value, std::size_t kCount>
Value oneOf(const std::array<Value, kCount>& values, numerics::RandomStream& random) {
  return values[std::min(kCount - 1, static_cast<std::size_t>(random.uniform() * kCount))];
}

std::size_t randomJoint(const NominalDay& day, numerics::RandomStream& random, std::size_t first = 0) {
  const std::size_t joints = day.mass_beyond.size();
  const auto drawn = static_cast<std::size_t>(random.uniform() * static_cast<double>(joints));
  return std::min(joints - 1, drawn) % (joints - first) + first;
}

std::string jointName(std::size_t j) { return fmt::format("joint {}", j + 1); }

/// A cause that turns joint j by size times a number of the posture.
template <class Of>
Moved onJoint(std::size_t j, Of of) {
  return [j, of](const NominalPosture& posture, int, const Vector3d& point, double size) {
    return turned(point, posture.on_axis[j], posture.axis[j], size * of(posture));
  };
}

/// The station turned about a random axis through it, or shifted, size times a number of the posture.
template <class Of>
Cause stationCause(UnloadedEffect effect, const NominalDay& day, numerics::RandomStream& random, Of of) {
  const Vector3d direction = random.normal3().normalized();
  if (random.uniform() < 0.5) {
    return {effect, "", "a shift", [=](const NominalPosture& posture, int, const Vector3d& point, double size) {
              return Vector3d(point + size * of(posture) * direction);
            }};
  }
  const Vector3d station = day.station;
  return {effect, "", "a turn", [=](const NominalPosture& posture, int, const Vector3d& point, double size) {
            return turned(point, station, direction, size * of(posture));
          }};
}

Cause drawTransmission(const NominalDay& day, numerics::RandomStream& random) {
  const std::size_t j = randomJoint(day, random);
  // An eccentric gear or ring, or a gear's own order.
  const double order = random.uniform() < 0.5 ? oneOf(std::array{1.0, 2.0}, random) : random.uniform(5.0, 40.0);
  const double phase = random.uniform(0.0, 2.0 * std::numbers::pi);
  return {UnloadedEffect::transmission_error, jointName(j), fmt::format("order {:.2f}", order),
          onJoint(j, [=](const NominalPosture& posture) {
            return std::sin(order * posture.q[static_cast<Eigen::Index>(j)] + phase);
          })};
}

Cause drawRatio(const NominalDay& day, numerics::RandomStream& random) {
  const std::size_t j = randomJoint(day, random), last = day.mass_beyond.size() - 1;
  std::size_t of = j;
  if (random.uniform() < 0.5) of = j == 0 ? 1 : j == last ? last - 1 : random.uniform() < 0.5 ? j - 1 : j + 1;
  const std::string detail =
      of == j ? jointName(j) : fmt::format("joints {} and {}", std::min(j, of) + 1, std::max(j, of) + 1);
  return {UnloadedEffect::ratio_error, detail, fmt::format("joint {} by joint {}", j + 1, of + 1),
          onJoint(j, [of](const NominalPosture& posture) { return posture.q[static_cast<Eigen::Index>(of)]; })};
}

Cause drawTargetMotion(const NominalDay& day, numerics::RandomStream& random, double from) {
  const auto target = std::min(day.targets.size() - 1,
                               static_cast<std::size_t>(random.uniform() * static_cast<double>(day.targets.size())));
  const Vector3d direction = random.normal3().normalized();
  return {UnloadedEffect::target_motion, day.targets[target], fmt::format("from {:.2f} of the day", from),
          [=](const NominalPosture& posture, int of, const Vector3d& point, double size) {
            if (of != static_cast<int>(target) || posture.time < from) return point;
            return Vector3d(point + size * (posture.motion.back().linear() * direction));
          }};
}

/// Own weight: joints twist about their axis, bearings tilt across it, links bend between two axes, the base rocks.
std::optional<Cause> drawOwnWeight(UnloadedEffect effect, const NominalDay& day, numerics::RandomStream& random) {
  if (!day.masses_known) return std::nullopt;
  if (effect == UnloadedEffect::base_compliance) {
    // A floor softer about one level axis than about the other.
    const double heading = random.uniform(0.0, std::numbers::pi);
    const Vector3d soft(std::cos(heading), std::sin(heading), 0.0);
    return Cause{effect, "", fmt::format("rocking about {:.0f} deg", heading * 180.0 / std::numbers::pi),
                 [&day, soft](const NominalPosture& posture, int, const Vector3d& point, double size) {
                   const Vector3d moment = momentBeyond(day, posture, 0, Vector3d::Zero());
                   return turned(point, Vector3d::Zero(), size * soft.dot(moment) * soft);
                 }};
  }
  if (effect == UnloadedEffect::link_compliance) {
    const std::size_t link = oneOf(std::array<std::size_t, 2>{1, 2}, random);  // upper arm, forearm
    return Cause{effect, fmt::format("link {}", link + 1), "",
                 [&day, link](const NominalPosture& posture, int, const Vector3d& point, double size) {
                   const Vector3d& from = posture.on_axis[link];
                   const Vector3d middle = 0.5 * (from + posture.on_axis[link + 1]);
                   const Vector3d along = (posture.on_axis[link + 1] - from).normalized();
                   // Curvature by the moment half way, as if all of it bent there.
                   return turned(point, middle, size * across(momentBeyond(day, posture, link + 1, middle), along));
                 }};
  }
  const std::size_t j = randomJoint(day, random, effect == UnloadedEffect::joint_compliance ? 1 : 0);
  const bool tilts = effect == UnloadedEffect::bearing_tilt;
  return Cause{effect, jointName(j), "",
               [&day, j, tilts](const NominalPosture& posture, int, const Vector3d& point, double size) {
                 const Vector3d moment = momentBeyond(day, posture, j, posture.on_axis[j]);
                 const Vector3d own = across(moment, posture.axis[j]);
                 return turned(point, posture.on_axis[j], size * (tilts ? own : Vector3d(moment - own)));
               }};
}

}  // namespace

NominalDay nominalDay(const campaign::Campaign& campaign, const calibration::Calibration& calibration) {
  NominalDay day;
  const robot::Robot& arm = campaign.robot;
  day.base_from_points = calibration.of(calibration::CalibratedModel::nominal).fit.basePointsMotion();
  if (campaign.tracker) day.station = day.base_from_points * campaign.tracker->station;
  day.flange_at_zero = arm.base_from_flange_at_zero.translation();
  day.gravity = campaign.gravity_in_base;
  day.masses_known = calibration.day.masses_known;
  day.targets = calibration.day.targets;
  day.postures.assign(campaign.pose_ids.size(), NominalPosture(arm.joints()));
  const auto joints = static_cast<std::size_t>(arm.joints());
  day.mass_beyond.resize(joints);
  for (std::size_t j = joints; j-- > 0;)
    day.mass_beyond[j] = arm.bodies[j + 1].mass_kg + (j + 1 < joints ? day.mass_beyond[j + 1] : 0.0);

  const std::vector<campaign::State>& states = campaign.states->rows;
  double first = 1e300, last = -1e300;
  bool timed = true;
  for (const campaign::State& state : states) {
    timed = timed && std::isfinite(state.time_s);
    first = std::min(first, state.time_s), last = std::max(last, state.time_s);
  }
  timed = timed && last > first;
  const JointVector still = JointVector::Zero(arm.joints());
  JointVector side = still;
  for (std::size_t s = 0; s < states.size(); ++s) {
    const JointVector move = s > 0 ? JointVector(states[s].q - states[s - 1].q) : still;
    constexpr double kStill = 1e-5;  // rad
    for (Eigen::Index j = 0; j < move.size(); ++j) {
      if (std::abs(move[j]) >= kStill) side[j] = move[j] > 0.0 ? 1.0 : -1.0;
    }
    if (states[s].step != 0) continue;
    NominalPosture& posture = day.postures[static_cast<std::size_t>(states[s].pose)];
    posture.q = states[s].q, posture.move = move, posture.side = side;
    posture.time = timed ? (states[s].time_s - first) / (last - first)
                         : static_cast<double>(s) / static_cast<double>(std::max<std::size_t>(1, states.size() - 1));
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    for (std::size_t j = 0; j < joints; ++j) {
      const metrology::Line& axis = arm.axes_in_base_at_zero[j];
      posture.on_axis[j] = motion * axis.point;
      posture.axis[j] = motion.linear() * axis.direction;
      motion = motion * Eigen::Translation3d(axis.point) *
               Eigen::AngleAxisd(posture.q[static_cast<Eigen::Index>(j)], axis.direction) *
               Eigen::Translation3d(-axis.point);
      posture.motion[j + 1] = motion;
    }
    Vector3d weighed = Vector3d::Zero();
    for (std::size_t j = joints; j-- > 0;) {
      weighed += arm.bodies[j + 1].mass_kg * (posture.motion[j + 1] * arm.bodies[j + 1].com_in_base_at_zero);
      if (day.mass_beyond[j] > 0.0) posture.weight_at[j] = weighed / day.mass_beyond[j];
    }
  }
  return day;
}

double mostPlausible(UnloadedEffect effect) {
  switch (effect) {
    case UnloadedEffect::joint_compliance:
    case UnloadedEffect::link_compliance:
    case UnloadedEffect::gravity_compensator:
      return 1e-3;
    case UnloadedEffect::bearing_tilt:
    case UnloadedEffect::base_compliance:
      return 1e-4;
    case UnloadedEffect::transmission_error:
    case UnloadedEffect::backlash:
    case UnloadedEffect::thermal_growth:
    case UnloadedEffect::scale_error:
      return 1e-2;
    case UnloadedEffect::kinematic_error:
    case UnloadedEffect::ratio_error:
    case UnloadedEffect::read_back_error:
    case UnloadedEffect::tracker_drift:
    case UnloadedEffect::frame_error:
    case UnloadedEffect::target_motion:
      return 0.1;
  }
  return 0.0;
}

std::optional<Cause> drawCause(UnloadedEffect effect, const NominalDay& day, numerics::RandomStream& random) {
  const double from = random.uniform(0.25, 0.75);
  const std::string when = fmt::format("from {:.2f} of the day", from);
  const auto later = [from](const NominalPosture& posture) { return posture.time >= from ? 1.0 : 0.0; };
  switch (effect) {
    case UnloadedEffect::kinematic_error:      // the rigid calibration takes it in
    case UnloadedEffect::gravity_compensator:  // these machines have none that could be wrong
      return std::nullopt;
    case UnloadedEffect::joint_compliance:
    case UnloadedEffect::link_compliance:
    case UnloadedEffect::bearing_tilt:
    case UnloadedEffect::base_compliance:
      return drawOwnWeight(effect, day, random);
    case UnloadedEffect::transmission_error:
      return drawTransmission(day, random);
    case UnloadedEffect::ratio_error:
      return drawRatio(day, random);
    case UnloadedEffect::backlash: {
      const std::size_t j = randomJoint(day, random);
      return Cause{effect, jointName(j), "", onJoint(j, [j](const NominalPosture& posture) {
                     return posture.side[static_cast<Eigen::Index>(j)];
                   })};
    }
    case UnloadedEffect::read_back_error: {
      // Behind the move or before it, no joint as much as the other.
      JointVector share(static_cast<Eigen::Index>(day.mass_beyond.size()));
      const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
      for (double& one : share) one = sign * random.uniform(0.5, 1.5);
      return Cause{effect, "", sign < 0.0 ? "behind" : "before",
                   [share](const NominalPosture& posture, int, const Vector3d& point, double size) {
                     return turnedByJoints(posture, point, size * share.cwiseProduct(posture.move));
                   }};
    }
    case UnloadedEffect::tracker_drift:
      return stationCause(effect, day, random, [](const NominalPosture& posture) { return posture.time; });
    case UnloadedEffect::frame_error: {
      Cause cause = stationCause(effect, day, random, later);
      cause.drawn += " " + when;
      return cause;
    }
    case UnloadedEffect::target_motion:
      return drawTargetMotion(day, random, from);
    case UnloadedEffect::thermal_growth: {
      // The arm's lengths, not the tool's, as a body warms up: quickly at first.
      const double constant = random.uniform(0.2, 2.0);
      return Cause{effect, "", fmt::format("time constant {:.2f} of the day", constant),
                   [&day, constant](const NominalPosture& posture, int, const Vector3d& point, double size) {
                     const double warm = 1.0 - std::exp(-posture.time / constant);
                     return Vector3d(point + size * warm * (posture.motion.back() * day.flange_at_zero));
                   }};
    }
    case UnloadedEffect::scale_error:
      return Cause{effect, "", when,
                   [later, &day](const NominalPosture& posture, int, const Vector3d& point, double size) {
                     return Vector3d(point + size * later(posture) * (point - day.station));
                   }};
  }
  return std::nullopt;
}

RigidGeometry::RigidGeometry(const NominalDay& day, std::vector<At> readings)
    : day_(day), readings_(std::move(readings)) {
  const auto rows = 3 * static_cast<Eigen::Index>(readings_.size());
  const auto targets = static_cast<Eigen::Index>(day.targets.size());
  constexpr Eigen::Index kOfBody = 6;
  const std::size_t bodies = day.mass_beyond.size();  // the base and those between two joints
  const Eigen::Index of_bodies = kOfBody * static_cast<Eigen::Index>(bodies);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(rows, of_bodies + 3 * targets);
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const At& at = readings_[i];
    const auto row = 3 * static_cast<Eigen::Index>(i);
    const NominalPosture& posture = day.postures[at.pose];
    for (std::size_t body = 0; body < bodies; ++body) {
      const Eigen::Matrix3d turn = posture.motion[body].linear();
      for (Eigen::Index k = 0; k < 3; ++k) {
        const auto column = kOfBody * static_cast<Eigen::Index>(body) + k;
        columns.block<3, 1>(row, column) = turn.col(k).cross(at.point - posture.motion[body].translation());
        columns.block<3, 1>(row, column + 3) = turn.col(k);
      }
    }
    columns.block<3, 3>(row, of_bodies + 3 * at.target) = posture.motion.back().linear();
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(1e-9);
  qr.compute(columns);
  basis_ = qr.householderQ() * Eigen::MatrixXd::Identity(rows, qr.rank());
}

RigidGeometry::Moves RigidGeometry::movesOf(const Cause& cause) const {
  constexpr double kSmall = 1e-6;  // any unit: far above rounding, far below where a turn curves
  Eigen::VectorXd moves(basis_.rows());
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const At& at = readings_[i];
    moves.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        (cause.moved(day_.postures[at.pose], at.target, at.point, kSmall) - at.point) / kSmall;
  }
  const Eigen::VectorXd beyond = moves - basis_ * (basis_.transpose() * moves);
  const double per_reading = 1.0 / std::sqrt(static_cast<double>(readings_.size()));
  return {per_reading * moves.norm(), per_reading * beyond.norm()};
}

campaign::Campaign withCause(const campaign::Campaign& campaign, const NominalDay& day, const Cause& cause,
                             double size) {
  campaign::Campaign other = campaign;
  for (campaign::LoadingReading& reading : other.loading->rows) {
    if (reading.step != 0) continue;
    const NominalPosture& posture = day.postures[static_cast<std::size_t>(reading.pose)];
    reading.point = day.base_from_points.inverse() *
                    cause.moved(posture, reading.target, day.base_from_points * reading.point, size);
  }
  return other;
}

}  // namespace stiffscope::bench
