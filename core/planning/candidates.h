#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/joint_reading.h"
#include "core/identification/identify.h"
#include "core/planning/remarks.h"
#include "core/robot/robot.h"
#include "metrology/remark.h"

namespace stiffscope::planning {

/// What joint angles a person at the robot would keep to, rad.
struct JointRules {
  /// Limits of the joints, as the controller states them; infinite: none, but half a turn either way of the URDF's
  /// angle. Beyond the machine's last joint they play no part.
  JointVector low = JointVector::Constant(kMostJoints, -std::numeric_limits<double>::infinity());
  JointVector high = JointVector::Constant(kMostJoints, std::numeric_limits<double>::infinity());
  double limit_margin = 0.0873;  ///< 5 deg within the URDF's: room for compensation, and URDFs differ from controllers
};

/// The joint angles that postures may have: the URDF's limits less the margin, and the rules' limits on what the
/// controller states. A joint of its own sign or offset has these as limits of its angle. Where another joint's figure
/// is added, a limit on the figure is one on the difference of two angles: the box, as wide as all figures within their
/// limits make it, holds more than they allow, and `hold` is asked of every posture.
class PostureLimits {
 public:
  /// Throws InputError, naming the joint, where the box is empty.
  PostureLimits(const robot::Robot& arm, const std::vector<campaign::JointReading>& readings, const JointRules& rules);

  const PerJoint<robot::JointLimits>& box() const { return box_; }

  /// Whether the controller's figures of angles in the box keep their limits.
  bool hold(const JointVector& q) const;

 private:
  PerJoint<robot::JointLimits> box_;
  std::optional<campaign::JointConvention> convention_;  ///< where the box is more than the figures' limits
  JointVector low_, high_;                               ///< of figures, rad
};

/// What is not known of the effects that the model has besides joint springs, as far as the data gave their sizes; what
/// else could hide is not in it.
struct EffectDoubt {
  /// How reflectors (places in the flange, m) move at joint angles q under a load (force R0, N; point in the flange, m)
  /// by one standard uncertainty of each independent direction of it: 3 rows a reflector, R0, m. Empty: no effects.
  std::function<Eigen::MatrixXd(const JointVector& q, const Eigen::Vector3d& force,
                                const Eigen::Vector3d& point_in_flange,
                                const std::vector<Eigen::Vector3d>& targets_in_flange)>
      moves;
  std::array<JointMatrix, 3> covariance;  ///< by Method: what it brings to the identified compliances, (rad/Nm)^2

  explicit operator bool() const { return static_cast<bool>(moves); }
};

/// What the user says of the day to come. Places in base_link or flange axes, m.
struct PlanningInputs {
  std::optional<double> load;  ///< N; empty: the mean force of the campaign's heaviest step
  std::optional<bool>
      pull;  ///< a cable pulls in any of several directions, or (false) the load hangs; empty: as measured
  std::optional<Eigen::Vector3d> hook_in_flange;   ///< where the load acts; empty: from the measured wrenches
  std::optional<Eigen::Vector3d> tracker_in_base;  ///< the station; empty: where the sweeps place it
  int repeats = 3;                                 ///< readings of a reflector in a state: their mean has less noise
  double tracker_sigma = 20e-6;                    ///< m per coordinate, where the campaign declares no tracker
  EffectDoubt effects;                             ///< of the model that identified; empty: joint springs alone
};

/// What a plan is made for: the arm in R0 with its reflectors, load and tracker, as far as they are known.
struct PlanningArm {
  frames::LoadingGeometry geometry;
  campaign::LoadCell cell;
  std::vector<Eigen::Vector3d> targets_in_flange;                ///< m
  Eigen::Vector3d outward_in_flange = Eigen::Vector3d::UnitZ();  ///< along the last axis, away from the arm
  Eigen::Vector3d hook_in_flange = Eigen::Vector3d::Zero();
  double load = 0.0;  ///< N; 0: a day without a load, whose postures keep no rules of one
  bool pull = false;
  std::optional<Eigen::Vector3d> station;        ///< in R0, m
  std::optional<metrology::TrackerNoise> noise;  ///< about `station`; empty: isotropic `sigma`
  double sigma = 0.0;                            ///< m per coordinate of one reading, where `noise` is empty
  double misfit = 0.0;  ///< m per coordinate: what the identified model leaves beyond the tracker's noise; 0 if unknown
  int repeats = 1;
  EffectDoubt effects;                                 ///< as in PlanningInputs
  std::vector<campaign::JointReading> joint_readings;  ///< what the controller states of the joints
  std::vector<Remark> assumed;                         ///< what was taken for granted

  /// Covariance of a reflector's displacement at `point` (R0), m^2: unloaded and loaded means, and the
  /// misfit.
  Eigen::Matrix3d displacementCovariance(const Eigen::Vector3d& point) const;
};

/// From a campaign before its day (robot, load cell, targets) or after it (`identified`, of the same
/// campaign): then sweeps, hook, load and misfit come from the measurement. Nominal reflector places (`x_mm
/// y_mm z_mm` of `target`) or, without them, three on a ring of 250 mm about the flange. Throws InputError
/// where the load is neither given nor measured, or no force.
PlanningArm planningArm(const campaign::Campaign& campaign, const identification::Identification* identified,
                        const PlanningInputs& inputs);

/// The arm of a day without a load, in base_link: R0 is base_link, nothing hangs, and only the tracker, its noise and
/// the repeats of `inputs` count.
PlanningArm unloadedPlanningArm(const campaign::Campaign& campaign, const PlanningInputs& inputs);

/// What a person at the robot would keep to. Lengths m, angles rad.
struct PostureRules : JointRules {
  double least_dexterity = 0.15;   ///< 1 / kappa of Dumas et al., lengths over 1 m
  double most_outward_up = 0.349;  ///< 20 deg: a hanging load stays clear of the flange (not asked of a pull)
  double least_hook_height = 0.8;  ///< above base_link's origin: weights hang below (not asked of a pull)
  double least_height = 0.2;       ///< of reflectors and forearm, above base_link's origin
  double line_clearance = 0.2;     ///< between the load's line beyond the hook and the arm's skeleton
  double body_clearance = 0.35;    ///< between hook or reflectors and the skeleton from the base to the forearm
  double sight_clearance = 0.1;    ///< between a line of sight and the skeleton
  double least_distance = 1.0, most_distance = 15.0;  ///< between tracker and reflectors
};

/// The rules in the order in which they are looked at.
enum class PostureRule { none, figures, follower, singularity, low, hanging, load_line, body, distance, sight };
inline constexpr std::size_t kPostureRules = 10;

/// In words, as in `n of m postures: WORDS`.
const char* wordsFor(PostureRule rule);

/// The first rule that a posture breaks under a load along `direction` (unit, R0); none where it keeps all.
/// The arm is taken as straight lines from base_link's origin over the points of its axes to the flange; it is
/// rigid here. Its forearm begins at the last axis before the wrist (axis 3 of six).
PostureRule brokenRule(const PlanningArm& arm, const PostureRules& rules, const robot::ArmPosture& posture,
                       const Eigen::Vector3d& direction);

/// A posture that keeps the rules, a load on it, and what measuring it would tell.
struct Candidate {
  JointVector q;                       ///< rad
  Eigen::Vector3d direction;           ///< of the load, unit, R0
  identification::LoadCase load_case;  ///< posture and wrench, R0; no readings
  /// Information on the compliances c: A^T S^-1 A over the posture's reflectors, A = J_m diag(J_w^T W) as in paper
  /// (12), S the covariance of their displacements: noise and, beyond it, misfit, and E E^T with E the moves by the
  /// effects' uncertainty (EffectDoubt), as if a new draw of them in every posture. (Nm/rad)^2.
  JointMatrix information;

  /// Of which nothing is known yet.
  Candidate(const JointVector& at, const Eigen::Vector3d& along)
      : q(at), direction(along), information(JointMatrix::Zero(at.size(), at.size())) {}
};

struct CandidateDraw {
  std::vector<Candidate> kept;
  std::array<int, kPostureRules> broken{};  ///< of the postures drawn, by the first rule broken
  int drawn = 0;
};

/// Uniform within the limits (PostureLimits), one load each: hanging along gravity, or a pull in one of nine directions
/// (horizontally along and against base_link's x and y, down, and half way between), drawn too. Stops at
/// `count` kept, or when 400 times as many were drawn. Throws InputError with the count of each rule broken
/// where not one keeps them all.
CandidateDraw drawCandidates(const PlanningArm& arm, const PostureRules& rules, int count, std::uint64_t seed);

/// The candidate of a given posture.
Candidate candidateAt(const PlanningArm& arm, const JointVector& q, const Eigen::Vector3d& direction);

/// Unit directions in R0 that a load may have.
std::vector<Eigen::Vector3d> loadDirections(const PlanningArm& arm);

/// Load-cell reading (N, Nm, in the cell's axes) that a candidate's load gives.
Vector6d expectedReading(const PlanningArm& arm, const Candidate& candidate);

}  // namespace stiffscope::planning
