#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/workspace/point_stiffness.h"

namespace stiffscope::workspace {

/// Joint angles at which the flange of the rigid arm stands at `base_from_flange`, nearest to `start` along the way:
/// Newton's steps with the Jacobian from there, so that the arm keeps its branch (elbow, wrist). Empty where they do
/// not converge, where a joint would leave its limits, or near a singularity (conditioning below `least_conditioning`).
///
/// Of more than six joints the steps are the least that lead there; the freedom that is left is not used. Fewer cannot
/// hold every pose: they bring the point `tcp_in_flange` of the flange where it is to be, the orientation as near as
/// the freedom that is left allows (compensation::jointStep), and empty where that turns it by more than `most_turned`,
/// rad.
std::optional<JointVector> continuedAngles(const robot::Robot& arm, const Eigen::Isometry3d& base_from_flange,
                                           const Eigen::Vector3d& tcp_in_flange, const JointVector& start,
                                           double least_conditioning, double most_turned);

struct SliceOptions {
  std::string pose;      ///< whose tool orientation and direction from axis 1 are held; empty: middlePosture
  double spacing = 0.0;  ///< of the places, m; 0: the number of the series 1-2-5 that gives about a dozen to the reach
  double least_conditioning = 0.01;  ///< as for compensation
  std::size_t most = 4000;           ///< places
};

struct SlicePlace {
  double radius = 0.0;  ///< of P_TCP from axis 1, m
  double height = 0.0;  ///< of P_TCP in R0, m
  PointStiffness at;
};

/// Stiffness in the vertical plane through axis 1 and the P_TCP of one posture, the tool turned as there: places on a
/// grid of radius and height that the arm reaches from that posture without leaving its branch, within its joint
/// limits. Arms of fewer than six joints may turn the tool by 10 deg from that, which C_x hardly feels. Of collisions
/// nothing is known.
struct StiffnessSlice {
  std::string pose;
  JointVector q;                                       ///< of that posture, rad
  double azimuth = 0.0;                                ///< of the plane about z0, from x0, rad
  double spacing = 0.0;                                ///< m
  Eigen::Vector3d outward = Eigen::Vector3d::UnitX();  ///< from axis 1, level; z0 is the other direction of the plane
  std::vector<SlicePlace> places;                      ///< by height, then radius
};

/// A posture of the campaign by its name.
struct NamedPosture {
  std::string pose;
  JointVector q;  ///< rad
};

/// The postures of the load cases, each once.
std::vector<NamedPosture> identifiedPostures(const campaign::Campaign& campaign,
                                             const identification::Identification& result);

/// The one whose joint angles are nearest to the means of all.
const NamedPosture& middlePosture(const std::vector<NamedPosture>& postures);

/// Of an arm with at least one posture. Throws InputError where `options.pose` is none of them, and where the grid
/// would have more places than `most`.
StiffnessSlice stiffnessSlice(const DeflectingArm& arm, const std::vector<NamedPosture>& postures,
                              const SliceOptions& options);

}  // namespace stiffscope::workspace
