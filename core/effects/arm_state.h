#pragma once

#include <array>
#include <vector>

#include "core/frames/arm_geometry.h"
#include "core/robot/wrench.h"

namespace stiffscope::effects {

/// Rigid motions of the arm's bodies beyond what its joints do, in R0: where effects in the model have moved
/// them.
using BodyMotions = std::array<Eigen::Isometry3d, 7>;
BodyMotions noBodyMotions();

/// The arm at rest in one state, in R0: everything that drives an effect. Own weight and load are kept apart,
/// because a deflection is the state less the unloaded one, and an absolute position has the own weight
/// alone.
struct ArmState {
  int pose = -1;  ///< -1 in sweeps
  int step = 0;
  double time_s = campaign::kNoTime;
  bool loaded = false;  ///< its force is above the share of the posture's largest that makes it a return to zero
  Vector6d q = Vector6d::Zero();
  Vector6d turned = Vector6d::Zero();  ///< joint angles with the sag in
  BodyMotions moved = noBodyMotions();
  robot::ArmPosture posture;            ///< at `turned`, its bodies moved
  std::array<metrology::Line, 6> axes;  ///< joint axes there; the point of each is the joint's origin
  Eigen::Isometry3d flange = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d cell_axes = Eigen::Matrix3d::Identity();  ///< base_from_cell: the axes the wrench was read in
  robot::Wrench load;                                       ///< on the tool; zero force where nothing pulls
  Vector6d load_torque = Vector6d::Zero();
  Vector6d weight_torque = Vector6d::Zero();  ///< zero where masses are not known
  /// By body b: the own weight of all bodies from b outwards, about the R0 origin.
  std::array<robot::Wrench, 7> weight_from_body;
  std::vector<int> targets;
  std::vector<Eigen::Vector3d> points;  ///< where the reflectors stand, one a target

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
    Vector6d load_torque = Vector6d::Zero();
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
  Vector6d q_ = Vector6d::Zero(), turned_ = Vector6d::Zero();
  std::vector<Eigen::Isometry3d> moved_;  // empty where no body is
  Eigen::Isometry3d flange_ = Eigen::Isometry3d::Identity();
  std::vector<int> targets_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<OfState> of_states_;
};

/// The geometry's part of a state: posture, axes, flange and gravity load at q with the gravity sag, its
/// joints turned by `joint_offset` (rad) besides.
ArmState stateAt(const frames::LoadingGeometry& geometry, const Vector6d& q, const Vector6d& joint_offset);

/// The geometry's part of a state at joint angles `turned`, its bodies moved.
ArmState stateMoved(const frames::LoadingGeometry& geometry, const Vector6d& q, const Vector6d& turned,
                    const BodyMotions& moved);

/// Brings an existing state there: what does not depend on angles and bodies stays.
void moveTo(const frames::LoadingGeometry& geometry, const Vector6d& turned, const BodyMotions& moved, ArmState& state);

/// The posture at these angles with its bodies moved.
robot::ArmPosture movedPosture(const robot::Robot& arm, const Vector6d& turned, const BodyMotions& moved);

/// The same from `state.posture`, wherever that came from: fills axes, flange and own weight.
void placeByPosture(const frames::LoadingGeometry& geometry, ArmState& state);

/// What body `body` carries beyond its inner joint, about `about`: own weight from that body outwards, plus
/// the load.
robot::Wrench carried(const ArmState& state, int body, const Eigen::Vector3d& about);

/// Own weight and load on the joints, Nm.
inline Vector6d totalTorque(const ArmState& state) { return state.load_torque + state.weight_torque; }

/// Displacements of the reflectors by small joint angles, stacked: one column a column of `angles`.
Eigen::MatrixXd byJoints(const ArmState& state, const Eigen::Matrix<double, 6, Eigen::Dynamic>& angles);

/// One column a joint: its angle alone.
Eigen::MatrixXd byEachJoint(const ArmState& state, const Vector6d& angles);

/// Displacement of the reflectors by a small motion: rotation about `pivot`, then shift.
Eigen::VectorXd byMotion(const ArmState& state, const Eigen::Vector3d& pivot, const Eigen::Vector3d& rotation,
                         const Eigen::Vector3d& shift);

/// Index of the posture's state with the largest force.
std::size_t heaviestState(const PostureStates& posture);

}  // namespace stiffscope::effects
