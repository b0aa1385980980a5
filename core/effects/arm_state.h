#pragma once

#include <vector>

#include "core/frames/arm_geometry.h"
#include "core/robot/wrench.h"

namespace stiffscope::effects {

/// Rigid motions of the arm's bodies beyond what its joints do, in R0: where effects in the model have moved
/// them.
using BodyMotions = PerBody<Eigen::Isometry3d>;
BodyMotions noBodyMotions(int bodies);

/// The arm at rest in one state, in R0: everything that drives an effect. Own weight and load are kept apart,
/// because a deflection is the state less the unloaded one, and an absolute position has the own weight
/// alone.
struct ArmState {
  int pose = -1;  ///< -1 in sweeps
  int step = 0;
  double time_s = campaign::kNoTime;
  double carriage = campaign::kNotGiven;  ///< reported position on the rail, m; not a number where nothing says it
  bool loaded = false;  ///< its force is above the share of the posture's largest that makes it a return to zero
  JointVector q;
  JointVector turned;  ///< joint angles with the sag in
  BodyMotions moved;
  robot::ArmPosture posture;  ///< at `turned`, its bodies moved
  robot::ArmAxes axes;        ///< joint axes there; the point of each is the joint's origin
  Eigen::Isometry3d flange = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d cell_axes = Eigen::Matrix3d::Identity();  ///< base_from_cell: the axes the wrench was read in
  robot::Wrench load;                                       ///< on the tool; zero force where nothing pulls
  JointVector load_torque;
  JointVector weight_torque;  ///< of own weight and balancers; zero where masses are not known
  /// By body b: the own weight of all bodies from b outwards, about the R0 origin.
  PerBody<robot::Wrench> weight_from_body;
  /// The same of the balancers; empty where there are none or masses are not known.
  PerBody<robot::Wrench> balancers_from_body;
  std::vector<int> targets;
  std::vector<Eigen::Vector3d> points;  ///< where the reflectors stand, one a target

  int joints() const { return axes.joints(); }
  int bodies() const { return static_cast<int>(axes.size()); }  ///< that move, one an axis
  Eigen::Index rows() const { return 3 * static_cast<Eigen::Index>(points.size()); }
};

/// All states of one posture in the order of the load steps; the first is unloaded.
using PostureStates = std::vector<ArmState>;

/// The states of one posture in a tenth of their room, for a day of ten thousand: the arm, which they have in common,
/// by its joint angles, and by state what the load is.
class CompactPosture {
 public:
  struct OfState {
    int step = 0;
    double time_s = campaign::kNoTime;
    bool loaded = false;
    Eigen::Matrix3d cell_axes = Eigen::Matrix3d::Identity();
    robot::Wrench load;
    JointVector load_torque;
  };

  CompactPosture() = default;
  /// States that differ by their loads alone, one at least.
  explicit CompactPosture(const PostureStates& posture);

  /// As they were, in the geometry in which they were made.
  PostureStates states(const frames::LoadingGeometry& geometry) const;

  int pose() const { return pose_; }
  void setPose(int pose) { pose_ = pose; }
  const Eigen::Isometry3d& flange() const { return flange_; }
  const std::vector<OfState>& ofStates() const { return of_states_; }

 private:
  int pose_ = -1;
  double carriage_ = campaign::kNotGiven;
  JointVector q_, turned_;
  std::vector<Eigen::Isometry3d> moved_;  // empty where no body is
  Eigen::Isometry3d flange_ = Eigen::Isometry3d::Identity();
  std::vector<int> targets_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<OfState> of_states_;
};

/// The geometry's part of a state: posture, axes, flange and gravity load at q with the gravity sag, its
/// joints turned by `joint_offset` (rad) besides.
ArmState stateAt(const frames::LoadingGeometry& geometry, const JointVector& q, const JointVector& joint_offset);

/// The geometry's part of a state at joint angles `turned`, its bodies moved.
ArmState stateMoved(const frames::LoadingGeometry& geometry, const JointVector& q, const JointVector& turned,
                    const BodyMotions& moved);

/// Brings an existing state there: what does not depend on angles and bodies stays.
void moveTo(const frames::LoadingGeometry& geometry, const JointVector& turned, const BodyMotions& moved,
            ArmState& state);

/// The posture at these angles with its bodies moved.
robot::ArmPosture movedPosture(const robot::Robot& arm, const JointVector& turned, const BodyMotions& moved);

/// The same from `state.posture`, wherever that came from: fills axes, flange and own weight.
void placeByPosture(const frames::LoadingGeometry& geometry, ArmState& state);

/// What body `body` carries beyond its inner joint, about `about`: own weight and balancers from that body outwards,
/// plus the load.
robot::Wrench carried(const ArmState& state, int body, const Eigen::Vector3d& about);

/// Own weight and load on the joints, Nm.
inline JointVector totalTorque(const ArmState& state) { return state.load_torque + state.weight_torque; }

/// Joint angles, one column a parameter, rad per unit.
using JointAngles = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostJoints, Eigen::Dynamic>;

/// Displacements of the reflectors by small joint angles, stacked: one column a column of `angles`.
Eigen::MatrixXd byJoints(const ArmState& state, const JointAngles& angles);

/// One column a joint: its angle alone.
Eigen::MatrixXd byEachJoint(const ArmState& state, const JointVector& angles);

/// Displacement of the reflectors by a small motion: rotation about `pivot`, then shift.
Eigen::VectorXd byMotion(const ArmState& state, const Eigen::Vector3d& pivot, const Eigen::Vector3d& rotation,
                         const Eigen::Vector3d& shift);

/// Index of the posture's state with the largest force.
std::size_t heaviestState(const PostureStates& posture);

}  // namespace stiffscope::effects
