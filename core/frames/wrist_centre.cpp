#include "core/frames/frames.h"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/frames/joint_axes.h"
#include "core/frames/remarks.h"
#include "core/numerics/parallel.h"
#include "core/robot/kinematics.h"
#include "metrology/lines.h"

namespace stiffscope::frames {

namespace {

struct SweepOfTargets {
  std::vector<metrology::SpherePoints> spheres;
  std::vector<int> targets;
};

SweepOfTargets collect(const campaign::Campaign& campaign, const ArmInR0& arm, const RigidPoints& points) {
  SweepOfTargets sweep;
  std::vector<int> sphere_of(campaign.targets.size(), -1);
  const bool weighted = campaign.tracker.has_value();
  const metrology::TrackerNoise noise = weighted ? trackerNoise(*campaign.tracker) : metrology::TrackerNoise{};
  const Eigen::Matrix3d turn = arm.r0_from_points.linear();
  for (std::size_t row = 0; row < campaign.wrist_sweep->rows.size(); ++row) {
    const campaign::WristReading& reading = campaign.wrist_sweep->rows[row];
    int& k = sphere_of[static_cast<std::size_t>(reading.target)];
    if (k < 0) {
      k = static_cast<int>(sweep.spheres.size());
      sweep.spheres.emplace_back();
      sweep.targets.push_back(reading.target);
    }
    metrology::SpherePoints& sphere = sweep.spheres[static_cast<std::size_t>(k)];
    sphere.points.push_back(arm.r0_from_points * points.wrist_sweep[row]);
    if (weighted)
      sphere.covariances.push_back(turn * noise.covarianceAt(reading.point, reading.from) * turn.transpose());
  }
  // A reflector with fewer than four readings has no sphere of its own; the others give the centre.
  constexpr std::size_t kSphere = 4;
  for (std::size_t k = sweep.spheres.size(); k-- > 0;) {
    if (sweep.spheres[k].points.size() >= kSphere) continue;
    sweep.spheres.erase(sweep.spheres.begin() + static_cast<std::ptrdiff_t>(k));
    sweep.targets.erase(sweep.targets.begin() + static_cast<std::ptrdiff_t>(k));
  }
  return sweep;
}

/// The pose of the station from which the wrist was read moves its centre as a whole: the largest, where there are
/// several.
void addStations(const campaign::Campaign& campaign, const ArmInR0& arm, WristCentre& wrist) {
  if (campaign.stations.empty()) return;
  const Eigen::Vector3d centre = arm.r0_from_points.inverse() * wrist.spheres.centre;
  Eigen::Matrix3d largest = Eigen::Matrix3d::Zero();
  for (const campaign::WristReading& reading : campaign.wrist_sweep->rows) {
    const Eigen::Matrix3d own = campaign::stationCovariance(campaign, reading.station, centre);
    if (own.trace() > largest.trace()) largest = own;
  }
  const Eigen::Matrix3d turn = arm.r0_from_points.linear();
  wrist.by_station = turn * largest * turn.transpose();
  wrist.spheres.covariance.topLeftCorner<3, 3>() += wrist.by_station;
}

bool armStoodStill(const campaign::WristSweep& sweep) {
  const JointVector& first = sweep.rows.front().q;
  const int arm = robot::armJointsOf(static_cast<int>(first.size()));
  for (const campaign::WristReading& reading : sweep.rows) {
    if ((reading.q.head(arm) - first.head(arm)).cwiseAbs().maxCoeff() > kStandsStill) return false;
  }
  return true;
}

/// The spheres about one centre, and each about its own.
struct SphereFits {
  metrology::SphereFit together;
  std::vector<metrology::SphereFit> alone;
};

SphereFits fitsOf(const SweepOfTargets& sweep) {
  SphereFits fits;
  fits.alone.resize(sweep.spheres.size());
  numerics::onAllCores(sweep.spheres.size() + 1, [&](std::size_t i) {
    if (i == 0) {
      fits.together = metrology::fitSpheres(sweep.spheres);
    } else {
      fits.alone[i - 1] = metrology::fitSpheres({sweep.spheres[i - 1]});
    }
  });
  return fits;
}

void fillTable(const SweepOfTargets& sweep, const std::vector<metrology::SphereFit>& fits, WristCentre& wrist) {
  for (std::size_t k = 0; k < sweep.spheres.size(); ++k) {
    const metrology::SphereFit& own = fits[k];
    if (!own.determined) continue;
    wrist.table.push_back({sweep.targets[k], own.centre, own.covariance.topLeftCorner<3, 3>(), own.radii[0], 0.0,
                           own.rms, static_cast<int>(sweep.spheres[k].points.size())});
    wrist.table_mean_in_r0 += own.centre;
  }
  if (wrist.table.empty()) return;
  wrist.table_mean_in_r0 /= static_cast<double>(wrist.table.size());
  for (WristTableRow& row : wrist.table) row.offset = (row.centre_in_r0 - wrist.table_mean_in_r0).norm();
}

void compareWithAxes(const ArmInR0& arm, const robot::ArmPosture& posture, WristCentre& wrist) {
  const int last = arm.arm.axes() - 1;
  std::optional<Eigen::Vector3d> met;  // on the axis that the next pair shares
  for (int first = arm.arm.armAxes(); first < last; ++first) {
    const metrology::CommonPerpendicular between = metrology::commonPerpendicular(
        robot::axisAt(arm.arm, posture, first), robot::axisAt(arm.arm, posture, first + 1));
    wrist.misses.push_back({first, between.distance});
    if (met) wrist.apart = std::max(wrist.apart, (between.foot_on_first - *met).norm());
    met = between.foot_on_second;
    wrist.nearest_last_axes_in_r0 = 0.5 * (between.foot_on_first + between.foot_on_second);
  }
}

}  // namespace

WristCentre measureWristCentre(const campaign::Campaign& campaign, const ArmInR0& arm, const RigidPoints& points,
                               const std::vector<std::optional<Eigen::Vector3d>>& targets_at_zero) {
  WristCentre wrist;
  const int carrying = robot::armJointsOf(arm.arm.joints());
  wrist.q.setZero(arm.arm.joints());
  if (campaign.wrist_sweep) wrist.q.head(carrying) = campaign.wrist_sweep->rows.front().q.head(carrying);
  const robot::ArmPosture posture = robot::postureAt(arm.arm, wrist.q);
  compareWithAxes(arm, posture, wrist);
  int seen = 0;
  for (const auto& target : targets_at_zero) {
    if (target) wrist.reflector_barycentre_in_r0 += posture.motion.back() * *target, ++seen;
  }
  if (seen > 0) wrist.reflector_barycentre_in_r0 /= seen;

  if (!arm.arm.wristStandsApart()) {
    wrist.reason = Remark(RemarkId::wrist_turns_arm);
    return wrist;
  }
  if (!campaign.wrist_sweep) {
    wrist.reason = Remark(RemarkId::no_wrist_sweep);
    return wrist;
  }
  if (!arm.points_placed) {
    wrist.reason = Remark(RemarkId::r0_not_in_frame_of_readings);
    return wrist;
  }
  // R0 is placed, so there are circle sweeps.
  if (campaign.wrist_sweep->frame != campaign.circle_sweeps->frame) {
    wrist.reason = Remark(RemarkId::wrist_sweep_in_other_frame);
    return wrist;
  }
  if (!armStoodStill(*campaign.wrist_sweep)) {
    wrist.reason = Remark(RemarkId::arm_moved_in_wrist_sweep, carrying);
    return wrist;
  }
  const SweepOfTargets sweep = collect(campaign, arm, points);
  if (sweep.spheres.empty()) {
    wrist.reason = Remark(RemarkId::wrist_reflectors_under_four);
    return wrist;
  }
  SphereFits fits = fitsOf(sweep);
  wrist.spheres = std::move(fits.together);
  if (!wrist.spheres.determined) {
    wrist.reason = wrist.spheres.reason;
    return wrist;
  }
  addStations(campaign, arm, wrist);
  wrist.centre_in_r0 = wrist.spheres.centre;
  wrist.targets = sweep.targets;
  wrist.centre_at_zero_in_r0 =
      posture.motion[static_cast<std::size_t>(arm.arm.armAxes())].inverse() * wrist.centre_in_r0;
  wrist.radii.assign(campaign.targets.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < sweep.targets.size(); ++k) {
    wrist.radii[static_cast<std::size_t>(sweep.targets[k])] = wrist.spheres.radii[k];
  }
  fillTable(sweep, fits.alone, wrist);
  wrist.measured = true;
  return wrist;
}

}  // namespace stiffscope::frames
