#include "core/identification/motor_side.h"

#include <cmath>

#include "core/frames/arm_geometry.h"
#include "core/identification/transmission.h"
#include "core/robot/gravity_load.h"

namespace stiffscope::identification {

namespace {

/// The URDF's arm in base_link.
frames::LoadingGeometry nominalGeometry(const campaign::Campaign& campaign) {
  frames::LoadingGeometry geometry;
  geometry.arm = campaign.robot;
  geometry.weight = robot::gravityLoad(campaign.robot, campaign.tool, campaign.gravity_in_base, campaign.robot,
                                       Eigen::Isometry3d::Identity());
  return geometry;
}

/// Compliances of the gears that the own weight winds up between what is held and what is read; the others zero.
JointVector heldGears(const Transmission& transmission) {
  const int joints = static_cast<int>(transmission.joints.size());
  JointVector gears = JointVector::Zero(joints);
  for (int j = 0; j < joints; ++j) {
    const GearTorsion& joint = transmission.joints[static_cast<std::size_t>(j)];
    if (joint.measured && joint.held == HeldSide::motor) gears[j] = transmission.estimate.compliance[j];
  }
  return gears;
}

JointVector weightWindUp(const frames::LoadingGeometry& geometry, const JointVector& q, const JointVector& gears) {
  if (!geometry.weight.links_known) return JointVector::Zero(q.size());
  return gears.cwiseProduct(robot::weightTorque(geometry.arm, robot::postureAt(geometry.arm, q), geometry.weight));
}

template <class Row>
void referSweep(std::optional<campaign::Table<Row>>& table, const frames::LoadingGeometry& geometry,
                const JointVector& gears) {
  if (!table) return;
  for (Row& row : table->rows) row.q -= weightWindUp(geometry, row.q, gears);
}

}  // namespace

campaign::Campaign referredToMotors(campaign::Campaign campaign) {
  if (!campaign.load_cell || !hasSecondEncoders(campaign)) return campaign;
  const frames::LoadingGeometry geometry = nominalGeometry(campaign);
  Transmission transmission = measureTransmission(campaign, geometry, JointVector::Zero(campaign.robot.joints()));
  const JointVector gears = heldGears(transmission);
  if (gears.isZero(0.0)) return campaign;
  // Once more with K_c as far as the gears make it.
  transmission = measureTransmission(campaign, geometry, gears);
  for (campaign::State& row : campaign.states->rows) {
    const JointVector by_weight = weightWindUp(geometry, row.q, gears);
    for (Eigen::Index j = 0; j < gears.size(); ++j) {
      if (gears[j] == 0.0) continue;
      row.extras().link_side[j] = row.q[j];
      const double offset = transmission.joints[static_cast<std::size_t>(j)].offset;
      // A row without the motor's angle: as the sweeps.
      row.q[j] = std::isnan(row.extras().motor_side[j]) ? row.q[j] - by_weight[j] : row.extras().motor_side[j] + offset;
    }
  }
  referSweep(campaign.circle_sweeps, geometry, gears);
  referSweep(campaign.wrist_sweep, geometry, gears);
  return campaign;
}

}  // namespace stiffscope::identification
