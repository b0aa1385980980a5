#pragma once

#include <string>
#include <vector>

#include "core/comparison/remarks.h"
#include "core/identification/identify.h"
#include "metrology/remark.h"

namespace stiffscope::comparison {

/// One posture that both campaigns measured under the same load: its place among the load cases of each.
struct PosturePair {
  std::string pose;
  std::size_t before = 0, after = 0;
};

/// A posture of either campaign that the other lacks, or has otherwise.
struct UnmatchedPosture {
  std::string pose;
  Remark reason;
};

struct MatchLimits {
  double angle = 1.745e-4;  ///< rad (0.01 deg): a robot comes back to a taught posture to a few thousandths
  double force = 0.02;      ///< of the larger force: the deflection goes with it, and 2 % is lost in the scatter
};

/// Whether joint angles (rad) and force vectors (R0, N) of two days differ by no more than that.
bool corresponds(const JointVector& q_before, const Eigen::Vector3d& force_before, const JointVector& q_after,
                 const Eigen::Vector3d& force_after, const MatchLimits& limits = {});

struct MatchedPostures {
  std::vector<PosturePair> pairs;  ///< in the order of the campaign before
  std::vector<UnmatchedPosture> unmatched;
};

/// Postures correspond where the pose id is the same, no joint angle differs by more than `limits.angle` and
/// the force vectors (R0) by more than `limits.force`. Every other posture is named with the reason.
MatchedPostures matchPostures(const campaign::Campaign& before_campaign, const identification::Identification& before,
                              const campaign::Campaign& after_campaign, const identification::Identification& after,
                              const MatchLimits& limits = {});

/// A reflector that both states of a posture read: its place among the targets of each load case.
struct ReflectorPair {
  std::size_t before = 0, after = 0;
};

/// By their ids, in the order of the campaign before.
std::vector<ReflectorPair> reflectorsInBoth(const campaign::Campaign& before_campaign,
                                            const identification::LoadCase& before,
                                            const campaign::Campaign& after_campaign,
                                            const identification::LoadCase& after);

/// m, rad: beyond what two descriptions of one arm round to.
inline constexpr double kSamePlace = 1e-3, kSameDirection = 1e-3;

/// Why the two nominal arms are not one machine: another number of joints, or an axis that stands more than 1 mm or
/// 1 mrad elsewhere in base_link. Empty where they are.
Remark differenceOfMachines(const robot::Robot& before, const robot::Robot& after);

/// What else in two URDFs with the same axes says that they are not of one machine: another name, a
/// flange elsewhere, other masses beyond joint 1. One machine in two states has one URDF.
std::vector<Remark> doubtsOfOneMachine(const robot::Robot& before, const robot::Robot& after);

}  // namespace stiffscope::comparison
