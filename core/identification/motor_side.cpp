#include "core/identification/motor_side.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "core/frames/arm_geometry.h"
#include "core/frames/joint_axes.h"
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

/// Readings of one sweep, in which the motors of some joints were held.
template <class Row>
struct SweepRows {
  std::vector<Row*> rows;
  std::vector<bool> held;  ///< by joint
};

/// What is left of a held motor's angle after its wind-up is taken off is what gear and masses are wrong by: the motor
/// stood. More than that part of the wind-up moved it.
template <class Row>
void standStill(const SweepRows<Row>& sweep, const std::vector<JointVector>& wind_up, const JointVector& gears) {
  constexpr double kWindUpKnown = 0.3;  // to this share: the masses of a URDF are wrong by a tenth and more
  for (Eigen::Index j = 0; j < gears.size(); ++j) {
    if (gears[j] == 0.0 || !sweep.held[static_cast<std::size_t>(j)]) continue;
    double moved = 0.0, wound = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
      moved = std::max(moved, std::abs(sweep.rows[i]->q[j] - sweep.rows.front()->q[j]));
      wound = std::max(wound, std::abs(wind_up[i][j] - wind_up.front()[j]));
      sum += sweep.rows[i]->q[j];
    }
    if (moved <= frames::kStandsStill || moved > kWindUpKnown * wound) continue;
    for (Row* const row : sweep.rows) row->q[j] = sum / static_cast<double>(sweep.rows.size());
  }
}

template <class Row>
void referSweep(const SweepRows<Row>& sweep, const frames::LoadingGeometry& geometry, const JointVector& gears) {
  std::vector<JointVector> wind_up;
  for (Row* const row : sweep.rows) {
    wind_up.push_back(weightWindUp(geometry, row->q, gears));
    row->q -= wind_up.back();
  }
  standStill(sweep, wind_up, gears);
}

void referSweeps(const frames::LoadingGeometry& geometry, const JointVector& gears, campaign::Campaign& campaign) {
  const auto joints = static_cast<std::size_t>(gears.size());
  if (campaign.circle_sweeps) {
    std::map<int, SweepRows<campaign::CircleReading>> by_axis;
    for (campaign::CircleReading& row : campaign.circle_sweeps->rows) by_axis[row.axis].rows.push_back(&row);
    for (auto& [axis, sweep] : by_axis) {
      sweep.held.assign(joints, true);
      sweep.held[static_cast<std::size_t>(axis)] = false;
      referSweep(sweep, geometry, gears);
    }
  }
  if (campaign.wrist_sweep) {
    SweepRows<campaign::WristReading> sweep;
    for (campaign::WristReading& row : campaign.wrist_sweep->rows) sweep.rows.push_back(&row);
    const auto arm = static_cast<std::size_t>(robot::armJointsOf(static_cast<int>(joints)));
    for (std::size_t j = 0; j < joints; ++j) sweep.held.push_back(j < arm);
    referSweep(sweep, geometry, gears);
  }
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
  referSweeps(geometry, gears, campaign);
  return campaign;
}

}  // namespace stiffscope::identification
