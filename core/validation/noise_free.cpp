#include "core/validation/noise_free.h"

#include <cmath>

#include "core/simulation/instruments.h"
#include "core/simulation/machine.h"
#include "core/simulation/measure.h"
#include "core/simulation/rotation.h"

namespace stiffscope::validation {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

ArmNow armAt(const robot::Robot& robot, const JointVector& q) {
  ArmNow now;
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  const JointVector angles = robot.axes_in_base_at_zero.angles(q);
  for (const metrology::Line& axis : robot.axes_in_base_at_zero) {
    const double angle = angles[static_cast<Index>(now.axes.size())];
    now.axes.push_back({motion * axis.point, motion.linear() * axis.direction});
    motion = motion * simulation::turnAbout(axis, angle);
  }
  now.flange = motion * robot.base_from_flange_at_zero;
  return now;
}

Vector3d sigmaAt(const campaign::Tracker& tracker, const Vector3d& point) {
  const double distance = (point - tracker.station).norm();
  const double across = tracker.angle_fixed + tracker.angle_per_m * distance;
  return {across, across, tracker.range_fixed + tracker.range_per_m * distance};
}

Eigen::Matrix3d sightAxes(const campaign::Tracker& tracker, const Vector3d& point) {
  return simulation::frameAlong(tracker.station, point - tracker.station).linear();
}

double rms(const VectorXd& values) {
  return values.size() == 0 ? 0.0 : std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

std::map<std::array<int, 3>, MeanPoint> stateMeans(const campaign::Campaign& campaign) {
  std::map<std::array<int, 3>, MeanPoint> means;
  for (const campaign::LoadingReading& reading : campaign.loading->rows) {
    MeanPoint& mean = means[{reading.pose, reading.step, reading.target}];
    mean.sum += reading.point;
    ++mean.count;
  }
  return means;
}

campaign::Campaign withoutScatter(const simulation::SimulationSpec& spec) {
  campaign::Campaign campaign = simulation::measureWithoutNoise(simulation::buildMachine(spec), spec);
  if (spec.load_cell && campaign.states) {
    simulation::LoadCellSpec cell = *spec.load_cell;
    cell.declared.force_sigma = cell.declared.moment_sigma = 0.0;
    simulation::addLoadCellErrors(cell, 0, *campaign.states);
  }
  return campaign;
}

}  // namespace stiffscope::validation
