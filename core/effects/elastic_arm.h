#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/effects/effect_model.h"
#include "core/frames/arm_geometry.h"
#include "core/robot/wrench.h"

namespace stiffscope::effects {

/// A load that keeps its force and moment in R0 and acts at a point fixed to the flange.
struct FlangeLoad {
  Eigen::Vector3d point_in_flange = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< R0 axes, N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< R0 axes, about the point, Nm
};

/// Joint angles of the arm on its springs: q + c (own weight's torque + load's torque), both on the moved
/// arm; fixed-point iteration to 1e-12 rad. `compliance` acts for both the weight and the load. Empty where
/// it does not settle (a load beyond buckling).
std::optional<JointVector> loadedAngles(const frames::LoadingGeometry& geometry, const JointVector& compliance,
                                        const JointVector& q, const FlangeLoad& load);

/// A load that keeps its force and moment in R0 and acts at a point fixed to the tool.
struct ToolLoad {
  Eigen::Vector3d point_at_zero = Eigen::Vector3d::Zero();  ///< where the point stands in R0 at all joints zero, m
  Eigen::Vector3d force = Eigen::Vector3d::Zero();          ///< R0 axes, N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();         ///< R0 axes, about the point, Nm
};

/// The arm on its joint springs and with what effects of the machine add, at rest, finite rotations: joint
/// springs turn by c tau plus the angles of effects that turn joints; a bearing's tilt, a link's tip and the
/// base move what lies beyond them, the plate the tool. Each by the effect's own equation, its moments and
/// axes taken where the deflected arm has them, so that what one deflects changes what the others carry; found
/// by fixed-point iteration until a step is below 1e-9 rad, a contraction of a hundredth a step.
class ElasticArm {
 public:
  /// Without effects: joint springs alone. Geometry, linearisation point and the effects' models must outlive
  /// the arm.
  ElasticArm(const frames::LoadingGeometry& geometry, const JointVector& compliance, const LinearizationPoint& at,
             std::vector<PresentEffect> effects);

  /// Motion of the tool (what lies beyond the plate; without one, the flange) from its place at all joints
  /// zero, in state `s` of a posture: its q, its history of loads, whether it is loaded; where it stands (as
  /// gravityEquilibrium gives it) is where the search begins. `load` acts there; null: the own weight alone. Empty
  /// where the arm does not come to rest.
  std::optional<Eigen::Isometry3d> toolMotion(const PostureStates& posture, std::size_t s, const ToolLoad* load) const;
  /// The same on states that the caller has for it: state `s` is moved, and put back.
  std::optional<Eigen::Isometry3d> toolMotion(PostureStates& posture, std::size_t s, const ToolLoad* load) const;

 private:
  struct Deflection;
  std::optional<Eigen::Isometry3d> settledTool(PostureStates& states, std::size_t s, const ToolLoad* load) const;
  Deflection deflectionBy(const PostureStates& posture, std::size_t s) const;

  const frames::LoadingGeometry& geometry_;
  JointVector compliance_;
  const LinearizationPoint& at_;
  std::vector<PresentEffect> effects_;
};

/// base_from_flange at rest with these joint commands under the load (one without force: the own weight
/// alone). Empty where the arm does not come to rest.
using RestingFlange =
    std::function<std::optional<Eigen::Isometry3d>(const JointVector& commands, const FlangeLoad& load)>;

/// An arm with effects that deflect besides its joint springs.
struct EffectDeflection {
  RestingFlange flange;
  JointMatrix spring_covariance;  ///< of the joint compliances, the effects taken as known
  /// The arm moved by one standard deviation along each independent direction of what else is uncertain,
  /// joint springs following: what such a move changes in a result is a standard uncertainty of it.
  std::vector<RestingFlange> varied;
};

}  // namespace stiffscope::effects
