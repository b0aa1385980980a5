#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/remarks.h"
#include "core/effects/effect.h"
#include "core/identification/estimate.h"
#include "core/identification/identification.h"
#include "core/robot/robot.h"
#include "metrology/remark.h"

namespace stiffscope::diagnosis {

/// 1 - rms after / rms before, on postures that took no part in the fit. Not a number where there are too few postures
/// to leave any out.
struct Shrink {
  double value = 0.0;
  double low = 0.0, high = 0.0;  ///< 95 %, the selection repeated inside

  bool judged() const { return !std::isnan(value); }
};

/// Effects that this data cannot tell apart, as one candidate.
struct EffectClass {
  std::vector<effects::Effect> effects;
  std::string detail;  ///< the pair, the reflector, the joint that it names; empty where nothing is named
  /// Fall of BIC against the model without it; larger is better. For the geometry, which no deflection is fitted by:
  /// the square of its rms over the tolerance, times the loading's equations.
  double score = 0.0;
  Shrink shrink;               ///< of the deflection's rms
  double explained = 0.0;      ///< that in variance, less noise
  Shrink shrink_of_positions;  ///< of unloaded absolute positions' misfit; all zero where they are not held
                               ///< against the arm
  bool in_verdict = false;
  Remark parameters;  ///< fitted values of the first effect
};

/// One member of a verdict: effects that cannot be told apart, or `unknown` where `effects` is empty.
struct VerdictEntry {
  std::vector<effects::Effect> effects;
  std::string detail;
};

/// What a diagnosis says is present. Empty `entries`: none.
struct Verdict {
  std::vector<VerdictEntry> entries;
  std::vector<Remark> reasons;  ///< a sentence each, with the free evidence that was used
};

/// The gap of the deflection, rms per coordinate, m.
struct Gap {
  double before = 0.0, noise = 0.0, after = 0.0;
  double deflection = 0.0;  ///< what was to be explained

  /// Share of its squares beyond the readings' noise that stays: 1 where nothing was explained.
  double shareLeft() const {
    const double least = noise * noise, was = before * before - least;
    const double is = std::max(0.0, after * after - least);
    return was > is ? is / was : 1.0;
  }
};

/// A part of the gap: its rms per coordinate, what noise alone would leave there, its share of the gap's
/// squares, and the normal deviate that noise exceeds as rarely, within numerics::kLargestDeviate.
struct WhereRow {
  std::string name;
  double rms = 0.0, noise = 0.0;  ///< m
  double share = 0.0;
  double significance = 0.0;
};

struct WhereTable {
  std::string by;  ///< "reflector", "base axes", ...
  std::vector<WhereRow> rows;
  /// Whether several parts could explain the same: it is then shared out among them, and they add up to `explained`,
  /// what all together explain of the gap's squares.
  bool overlaps = false;
  double explained = 0.0;
};

/// What is left of one reflector's displacement in the load state of its posture that leaves the most, R0, m.
struct PointGap {
  int pose = 0;                                     ///< index into Campaign::pose_ids
  int target = 0;                                   ///< index into Campaign::targets
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< where it stands
  Eigen::Vector3d before = Eigen::Vector3d::Zero(), after = Eigen::Vector3d::Zero();
};

struct DetectableSize {
  effects::Effect effect = effects::Effect::link_compliance;
  std::optional<double> size;  ///< rms per coordinate of its displacements, m; empty: not testable here
};

struct NotTestable {
  effects::Effect effect = effects::Effect::link_compliance;
  Remark missing;
};

/// A measurement that would separate what is tied, or make something testable.
struct NextMeasurement {
  std::vector<effects::Effect> separates;
  Remark what;
  double gain = 0.0;  ///< of chi2 between the tied effects, expected; 0 where it makes something testable
};

/// The geometry found against the nominal one (kinematic_error): where the URDF's axes would put the
/// reflectors at the postures of the loading (of the sweeps without any), base and reflectors placed as well
/// as can be, against where the axes that were found put them. No load, no own weight.
struct GeometryError {
  bool tested = false;
  Remark reason;               ///< why not
  double rms = 0.0;            ///< per coordinate, m
  double limit = 0.0;          ///< above it, it is named
  double largest_shift = 0.0;  ///< of an axis, across it, m
  double largest_tilt = 0.0;   ///< of an axis, rad
};

/// What identification states of the joints' stiffnesses, 95 %, Nm/rad.
struct StatedStiffness {
  identification::Method method = identification::Method::decoupled_partial_pose;
  JointVector expanded;  ///< U; infinite where the interval is open
  PerJoint<identification::CoverageInterval> interval;
};

/// Answer of `diagnose`.
struct Diagnosis {
  Diagnosis() = default;  ///< of no machine yet
  /// Of a machine of so many joints.
  explicit Diagnosis(int joints)
      : stiffness_before(JointVector::Zero(joints)),
        stiffness_after(stiffness_before),
        stiffness_after_sd(stiffness_before),
        identifiable(static_cast<std::size_t>(joints), false) {}

  bool usable = false;
  Remark unusable_reason;
  Verdict verdict;
  std::vector<EffectClass> classes;                   ///< the verdict's first, then the others; best first
  std::vector<std::vector<effects::Effect>> aliases;  ///< by the postures and loads alone, before any residual
  std::vector<DetectableSize> detectable;
  std::vector<NotTestable> not_testable;
  Gap gap, positions;  ///< of the deflection; of unloaded absolute positions (deflection 0)
  bool positions_tested = false;
  std::vector<WhereTable> where, where_positions;  ///< of what stiffnesses alone leave
  std::vector<WhereTable> where_after;             ///< of the deflection, with the verdict's effects in the model
  /// By stiffnesses alone (of the readings as they were, where they were corrected for the station), and with the
  /// verdict's effects.
  std::vector<PointGap> at_points;
  WhereTable as_measured;  ///< by posture, of the readings as they were; no rows where nothing was corrected for
  std::vector<NextMeasurement> next;
  GeometryError geometry;

  double state_noise = 0.0;  ///< rms noise of one state's displacement, per coordinate, m
  Remark noise_source;
  double noise_factor_along = 1.0, noise_factor_across = 1.0;  ///< found against declared
  double significance_limit = 0.0;  ///< least fall of BIC that counts: 20, or more where chance reaches more in 1 %
  double size_limit = 0.0;          ///< below it an effect is too small to matter, m
  double lack_of_fit = 0.0;         ///< chi2 per degree of freedom of the loading without any effect
  double left_over = 0.0;           ///< the same with the effects that the fit chose
  double left_over_limit = 0.0;     ///< what chance makes of it
  double model_error = 0.0;         ///< rms per coordinate that no effect explains, at the largest load, m; 0: none
  double geometric_stiffness_share = 0.0;
  Shrink shrink_together;  ///< by all that the fit chose
  /// Nm/rad, by springs alone and with the verdict's effects, with the standard uncertainty: those of the joint fit of
  /// all load steps; where a model of identification is at hand (extended_model::stateStiffnesses), those of its
  /// method.
  JointVector stiffness_before, stiffness_after;
  JointVector stiffness_after_sd;
  robot::JointMask identifiable;
  std::optional<StatedStiffness> stated;  ///< what that method states of them
  int postures = 0, states = 0;
};

}  // namespace stiffscope::diagnosis
