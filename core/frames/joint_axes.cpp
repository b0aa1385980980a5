#include "core/frames/joint_axes.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <set>

#include "core/frames/coupled_axes.h"
#include "core/frames/remarks.h"
#include "core/numerics/parallel.h"
#include "metrology/linear_algebra.h"
#include "metrology/lines.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::frames {

namespace {

/// How axis `axis` at zero moves with the axes before it at zero: 4 x 4 axis.
Eigen::MatrixXd byEarlierAxes(const MeasuredAxes& axes, std::size_t axis) {
  std::vector<metrology::MeasuredLine> earlier;
  for (std::size_t before = 0; before < axis; ++before) earlier.push_back(axes[before].at_zero);
  return metrology::derivativesByLines(earlier, [&](const std::vector<metrology::Line>& moved) -> Eigen::VectorXd {
    const metrology::Line back = turnedBack(moved, axes[axis].swept_at, axes[axis].as_swept.line);
    return axes[axis].at_zero.stepTo(back);
  });
}

}  // namespace

AxesCovariance axesCovariance(const MeasuredAxes& axes) {
  const auto size = static_cast<Eigen::Index>(4 * axes.size());
  AxesCovariance by_fits = AxesCovariance::Zero(size, size), of_fits = by_fits;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    if (!axes[axis].measured) continue;
    const auto at = static_cast<Eigen::Index>(4 * axis);
    of_fits.block<4, 4>(at, at) = axes[axis].as_swept.covariance;
    by_fits.block<4, 4>(at, at).setIdentity();
    const bool turned = (axes[axis].swept_at.head(static_cast<Eigen::Index>(axis)).array() != 0.0).any();
    if (turned) by_fits.middleRows<4>(at) += byEarlierAxes(axes, axis) * by_fits.topRows(at);
  }
  return propagated(by_fits, of_fits);
}

namespace {

Eigen::Isometry3d turnAbout(const metrology::Line& axis, double angle) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, axis.direction).toRotationMatrix();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = turn;
  motion.translation() = axis.point - turn * axis.point;
  return motion;
}

struct Sweep {
  std::vector<metrology::CirclePoints> circles;
  std::vector<std::vector<double>> angles;  ///< of the turning joint, per circle and point
  std::vector<int> targets;
  JointVector q;  ///< of the first reading
  bool others_moved = false;
  std::set<int> stations;  ///< from which it was read
};

Sweep collect(const campaign::Campaign& campaign, int axis, const RigidPoints& points) {
  Sweep sweep;
  std::map<int, std::size_t> circle_of;
  const bool weighted = campaign.tracker.has_value();
  const metrology::TrackerNoise noise = weighted ? trackerNoise(*campaign.tracker) : metrology::TrackerNoise{};
  bool first = true;
  for (std::size_t row = 0; row < campaign.circle_sweeps->rows.size(); ++row) {
    const campaign::CircleReading& reading = campaign.circle_sweeps->rows[row];
    if (reading.axis != axis) continue;
    if (first) sweep.q = reading.q, first = false;
    sweep.stations.insert(reading.station);
    for (int joint = 0; joint < campaign.robot.joints(); ++joint) {
      if (joint != axis && std::abs(reading.q[joint] - sweep.q[joint]) > kStandsStill) sweep.others_moved = true;
    }
    const auto [place, added] = circle_of.try_emplace(reading.target, sweep.circles.size());
    if (added) {
      sweep.circles.emplace_back();
      sweep.angles.emplace_back();
      sweep.targets.push_back(reading.target);
    }
    sweep.circles[place->second].points.push_back(points.circle_sweeps[row]);
    if (weighted) sweep.circles[place->second].covariances.push_back(noise.covarianceAt(reading.point, reading.from));
    sweep.angles[place->second].push_back(reading.q[axis]);
  }
  return sweep;
}

/// How far the readings scatter when each is turned back by its joint angle: least for the right sense of the axis.
double scatterTurnedBack(const Sweep& sweep, const metrology::Line& axis, double sense) {
  double scatter = 0.0;
  for (std::size_t k = 0; k < sweep.circles.size(); ++k) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double squares = 0.0;
    for (std::size_t i = 0; i < sweep.circles[k].points.size(); ++i) {
      const Eigen::Vector3d back =
          Eigen::AngleAxisd(-sense * sweep.angles[k][i], axis.direction) * (sweep.circles[k].points[i] - axis.point);
      sum += back;
      squares += back.squaredNorm();
    }
    scatter += squares - sum.squaredNorm() / static_cast<double>(sweep.circles[k].points.size());
  }
  return scatter;
}

/// What the poses of the stations put into an axis that was read from them: the largest, where there are several.
Eigen::Matrix4d byStations(const campaign::Campaign& campaign, const std::set<int>& stations,
                           const metrology::MeasuredLine& axis) {
  Eigen::Matrix4d largest = Eigen::Matrix4d::Zero();
  if (campaign.stations.empty()) return largest;
  Eigen::Matrix<double, 4, 3> by_shift, by_tilt;
  by_shift << axis.across_u.transpose(), axis.across_v.transpose(), Eigen::Matrix<double, 2, 3>::Zero();
  by_tilt << Eigen::Matrix<double, 2, 3>::Zero(), axis.across_u.transpose(), axis.across_v.transpose();
  for (const int s : stations) {
    const campaign::StationPlace& place = campaign.stations[static_cast<std::size_t>(s)];
    Eigen::Matrix<double, 4, 6> by_pose;  // of a rotation vector, then a displacement at the place's centre
    by_pose.leftCols<3>() = -by_shift * metrology::crossMatrix(axis.line.point - place.centre) -
                            by_tilt * metrology::crossMatrix(axis.line.direction);
    by_pose.rightCols<3>() = by_shift;
    const Eigen::Matrix4d covariance = by_pose * place.covariance * by_pose.transpose();
    if (covariance.trace() > largest.trace()) largest = covariance;
  }
  return largest;
}

/// Turns the measured axis back through the axes before it; false with the reason where one of those is unknown.
bool turnBackToZero(const MeasuredAxes& axes, int axis, MeasuredAxis& measured) {
  Eigen::Isometry3d back = Eigen::Isometry3d::Identity();
  for (int before = 0; before < axis; ++before) {
    if (measured.swept_at[before] == 0.0) continue;
    const MeasuredAxis& earlier = axes[static_cast<std::size_t>(before)];
    if (!earlier.measured) {
      measured.reason = Remark(RemarkId::earlier_axis_not_known, before + 1);
      return false;
    }
    back = turnAbout(earlier.at_zero.line, -measured.swept_at[before]) * back;
  }
  metrology::MeasuredLine& line = measured.at_zero;
  line = measured.as_swept;
  line.line = {back * line.line.point, back.linear() * line.line.direction};
  line.across_u = back.linear() * line.across_u;
  line.across_v = back.linear() * line.across_v;
  return true;
}

/// Of a coupled arm no axis has circles of its own: they have what all sweeps together say.
void measureCoupled(const campaign::Campaign& campaign, const RigidPoints& points, MeasuredAxes& axes) {
  const CoupledAxes found = fitCoupledAxes(campaign, points);
  std::set<int> stations;
  if (campaign.circle_sweeps) {
    for (const campaign::CircleReading& reading : campaign.circle_sweeps->rows) stations.insert(reading.station);
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].measured = found.reason.empty();
    axes[i].reason = axes[i].measured ? Remark(RemarkId::coupled_joints) : found.reason;
    if (!axes[i].measured) continue;
    axes[i].as_swept = found.at_zero[i];
    axes[i].as_swept.covariance += byStations(campaign, stations, axes[i].as_swept);
    axes[i].at_zero = axes[i].as_swept;
    axes[i].fit.rms = found.rms;
    axes[i].fit.chi2_per_dof = found.chi2_per_dof;
  }
}

}  // namespace

metrology::Line turnedBack(const std::vector<metrology::Line>& axes_at_zero, const JointVector& q,
                           metrology::Line line) {
  for (std::size_t before = 0; before < axes_at_zero.size(); ++before) {
    const Eigen::Isometry3d back = turnAbout(axes_at_zero[before], -q[static_cast<Eigen::Index>(before)]);
    line = {back * line.point, back.linear() * line.direction};
  }
  return line;
}

metrology::TrackerNoise trackerNoise(const campaign::Tracker& tracker) {
  return {tracker.range_fixed, tracker.range_per_m, tracker.angle_fixed, tracker.angle_per_m, tracker.station};
}

namespace {

/// The axis where the arm stood when it was swept; says why where there is none.
void measureAsSwept(const campaign::Campaign& campaign, int axis, const RigidPoints& points, MeasuredAxis& measured) {
  if (!campaign.circle_sweeps) {
    measured.reason = Remark(RemarkId::no_circle_sweeps);
    return;
  }
  const Sweep sweep = collect(campaign, axis, points);
  if (sweep.circles.empty()) {
    measured.reason = Remark(RemarkId::not_swept);
    return;
  }
  if (sweep.others_moved) {
    measured.reason = Remark(RemarkId::other_joints_moved);
    return;
  }
  measured.fit = metrology::fitAxis(sweep.circles);
  measured.targets = sweep.targets;
  if (!measured.fit.determined) {
    measured.reason = measured.fit.reason;
    return;
  }
  measured.swept_at = sweep.q;
  measured.as_swept = measured.fit.axis;
  measured.as_swept.covariance += byStations(campaign, sweep.stations, measured.as_swept);
  const metrology::Line& line = measured.as_swept.line;
  if (scatterTurnedBack(sweep, line, -1.0) < scatterTurnedBack(sweep, line, 1.0)) {
    measured.as_swept = measured.as_swept.reversed();
  }
}

}  // namespace

MeasuredAxes measureAxes(const campaign::Campaign& campaign, const RigidPoints& points) {
  const int joints = campaign.robot.joints();
  MeasuredAxes axes(static_cast<std::size_t>(campaign.robot.axes()), MeasuredAxis(joints));
  if (campaign.robot.coupled()) {
    measureCoupled(campaign, points, axes);
    return axes;
  }
  numerics::onAllCores(
      static_cast<std::size_t>(joints),
      [&](std::size_t axis) { measureAsSwept(campaign, static_cast<int>(axis), points, axes[axis]); },
      campaign.circle_sweeps.has_value());
  for (int axis = 0; axis < joints; ++axis) {  // each about those before it
    MeasuredAxis& measured = axes[static_cast<std::size_t>(axis)];
    if (measured.fit.determined) measured.measured = turnBackToZero(axes, axis, measured);
  }
  const AxesCovariance covariance = axesCovariance(axes);
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const auto at = static_cast<Eigen::Index>(4 * axis);
    axes[axis].at_zero.covariance = covariance.block<4, 4>(at, at);
  }
  return axes;
}

}  // namespace stiffscope::frames
