#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/comparison/paired_fit.h"
#include "core/identification/identification.h"
#include "core/preparation/finding.h"
#include "metrology/lines.h"

namespace stiffscope::fleet {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// With loads, without, or of sweeps alone.
enum class DayKind { loaded, unloaded, sweeps };

/// A number with its 95 % interval; ends are not numbers where none can be stated.
struct Stated {
  double value = kUnknown, low = kUnknown, high = kUnknown;
};

/// A posture under the load that identified, or without any: what says whether another day has it too.
struct LoadedPosture {
  std::string pose;
  JointVector q;                                    ///< rad
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< R0, N
};

/// Compliances of one day by one method and joint springs alone, or by the arm's own weight, with what makes
/// differences of days: the influences of its postures, in which what the model misses is the same on every day
/// (comparison::PairedFit), and the variances that its postures share and other days do not.
struct SpringsOfDay {
  explicit SpringsOfDay(int joints)
      : compliance(JointVector::Zero(joints)),
        identifiable(static_cast<std::size_t>(joints), false),
        shared(compliance),
        dof(compliance) {}

  bool available = false;
  JointVector compliance;  ///< rad/Nm
  robot::JointMask identifiable;
  JointVector shared;                   ///< variances, (rad/Nm)^2
  JointVector dof;                      ///< of the scatter between postures
  std::vector<JointVector> influences;  ///< one a posture, rad/Nm
};

/// One entry of a diagnosis: effects that the day cannot tell apart, by their ids; `unknown` alone where none explains.
struct EffectFound {
  std::vector<std::string> effects;
  std::string detail;
};

/// What a fleet keeps of one campaign of a machine of so many joints: SI units and radians.
struct CampaignResult {
  explicit CampaignResult(int joints)
      : stiffness(static_cast<std::size_t>(joints)),
        springs{SpringsOfDay(joints), SpringsOfDay(joints), SpringsOfDay(joints)},
        own_weight(joints) {}

  int joints() const { return static_cast<int>(stiffness.size()); }

  std::string name, date, robot;
  DayKind kind = DayKind::loaded;
  campaign::DoubleEncoder encoders = campaign::DoubleEncoder::unspecified;
  PerJoint<metrology::Line> axes;  ///< of the URDF's arm, as robot::Robot has them: days of others are not compared

  preparation::AuditVerdict audit = preparation::AuditVerdict::not_testable;
  std::vector<std::string> failed_checks, warned_checks;  ///< ids
  int postures = 0;

  // Of a day with loads.
  std::optional<identification::Method> method;  ///< shown first
  /// Of the day's model, of a day without loads by own weight, Nm/rad; high infinite where it is open.
  PerJoint<Stated> stiffness;
  double deflection = kUnknown;                          ///< mean at the reflectors, m
  Stated compensated;                                    ///< share of it on postures held out
  std::array<SpringsOfDay, 3> springs;                   ///< by Method
  std::optional<identification::Method> springs_method;  ///< shown first of these
  std::vector<LoadedPosture> loaded_postures;            ///< of the influences, in their order, of either kind of day

  // Of a day without. Accuracies: rms per coordinate, m.
  SpringsOfDay own_weight;     ///< see ownWeightSprings
  Stated nominal, calibrated;  ///< the URDF's arm with base and reflectors fitted; the calibrated one, held out

  // What the model misses: rms per coordinate, m.
  double gap_before = kUnknown, gap_noise = kUnknown, gap_after = kUnknown;
  bool diagnosed = false;
  std::vector<EffectFound> effects;  ///< of the verdict; empty: none

  bool hasUnknown() const;
};

/// Two days of one machine of so many joints, one after the other.
struct PairResult {
  explicit PairResult(int joints)
      : difference(static_cast<std::size_t>(joints)),
        taken(difference),
        p_value(static_cast<std::size_t>(joints), kUnknown) {}

  DayKind kind = DayKind::loaded;
  std::string reason;  ///< why they cannot be compared, in words; then nothing else is filled
  bool same_postures = false;
  int postures = 0;  ///< of both

  // c_after - c_before by joint, rad/Nm (comparison::StiffnessChange); without a method by own weight.
  std::optional<identification::Method> method;
  PerJoint<Stated> difference;  ///< not a number where the joint cannot be compared
  PerJoint<Stated> taken;       ///< share of the compliance before that is gone
  PerJoint<double> p_value;

  // Of days without loads, beside the compliances (comparison::GeometryChange).
  double machine_p = kUnknown;   ///< of an unchanged machine
  double at_targets = kUnknown;  ///< rms of the 3-D position by the change, m
  double at_targets_sd = kUnknown;
  std::string cause;  ///< what explains it, in words
};

}  // namespace stiffscope::fleet
