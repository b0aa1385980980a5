#include "core/frames/frames.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/frames/remarks.h"
#include "core/numerics/parallel.h"
#include "core/robot/kinematics.h"
#include "metrology/linear_algebra.h"
#include "metrology/lines.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::frames {

Frames::Frames() = default;
Frames::Frames(const Frames&) = default;
Frames::Frames(Frames&&) noexcept = default;
Frames& Frames::operator=(const Frames&) = default;
Frames& Frames::operator=(Frames&&) noexcept = default;
Frames::~Frames() = default;

namespace {

/// The axes at zero, in R0 as it is measured; those that are not measured stand there without uncertainty.
std::vector<metrology::MeasuredLine> axesInR0(const MeasuredAxes& axes, const ArmInR0& arm) {
  std::vector<metrology::MeasuredLine> lines;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    metrology::MeasuredLine line;
    if (axes[i].measured) {
      line = axes[i].at_zero;
      line.line = {arm.r0_from_points * line.line.point, arm.r0_from_points.linear() * line.line.direction};
      line.across_u = arm.r0_from_points.linear() * line.across_u;
      line.across_v = arm.r0_from_points.linear() * line.across_v;
    } else {
      line.line = arm.arm.axes_in_base_at_zero[i];
      metrology::basisAcross(line.line.direction, line.across_u, line.across_v);
    }
    lines.push_back(line);
  }
  return lines;
}

metrology::Line directedAlong(const Eigen::Vector3d& direction, metrology::Line line) {
  if (line.direction.dot(direction) < 0.0) line.direction = -line.direction;
  return line;
}

/// Error of R0, distances and angles, as they follow from the axes; smooth where distances and angles are zero.
metrology::LineNumbers numbersOf(const std::vector<metrology::MeasuredLine>& axes, const Links& links) {
  const FramesLayout at(static_cast<int>(axes.size()));
  std::vector<metrology::LinePairNumber> distances, angles;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const metrology::MeasuredLine &first = axes[i], &second = axes[i + 1];
    distances.push_back(links[i].near_parallel ? metrology::LinePairNumber()
                                               : metrology::signedDistance(first.line, second.line));
    // Exactly parallel axes, as only drawings have them, tilt about any normal.
    const Eigen::Vector3d normal = metrology::commonNormal(first.line, second.line).value_or(first.across_u);
    angles.push_back(metrology::tiltAbout(normal, first.line, second.line));
  }
  return [at, distances, angles](const std::vector<metrology::Line>& moved) {
    Eigen::VectorXd numbers(at.wrist_centre);
    const Eigen::Isometry3d r0 = metrology::baseFrame(directedAlong(Eigen::Vector3d::UnitZ(), moved[0]),
                                                      directedAlong(Eigen::Vector3d::UnitY(), moved[1]));
    numbers.segment<6>(FramesLayout::kR0) = metrology::frameError(Eigen::Isometry3d::Identity(), r0);
    const robot::ArmAxes lines(moved.begin(), moved.end());
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      numbers[FramesLayout::kDistances + row] =
          distances[i] ? distances[i](lines[i], lines[i + 1])
                       : metrology::distanceAcross(lines[i], lines[i + 1], hayatiPoint(lines, i));
      numbers[at.angles + row] = angles[i](lines[i], lines[i + 1]);
    }
    return numbers;
  };
}

void addWrist(const WristCentre& wrist, const FramesLayout& at, Eigen::MatrixXd& covariance) {
  const auto place = [&](Eigen::Index i) {
    return i < 3 ? at.wrist_centre + i : at.radii + wrist.targets[static_cast<std::size_t>(i - 3)];
  };
  const Eigen::MatrixXd& own = wrist.spheres.covariance;
  for (Eigen::Index i = 0; i < own.rows(); ++i) {
    for (Eigen::Index j = 0; j < own.cols(); ++j) covariance(place(i), place(j)) += own(i, j);
  }
}

}  // namespace

Eigen::MatrixXd FramesCovariance::total() const {
  Eigen::MatrixXd all =
      readings + sag + scale_sd * scale_sd * by_scale * by_scale.transpose() + by_masses * by_masses.transpose();
  if (hidden.size() > 0) all += hidden;
  return all;
}

FramesCovariance framesCovariance(const MeasuredAxes& axes, const ArmInR0& arm, const Links& links,
                                  const WristCentre& wrist, std::size_t targets, const Eigen::Vector3d& station) {
  const FramesLayout at(static_cast<int>(axes.size()));
  const Eigen::Index size = at.count(targets);
  FramesCovariance covariance{Eigen::MatrixXd::Zero(size, size),
                              Eigen::MatrixXd::Zero(size, size),
                              Eigen::VectorXd::Zero(size),
                              Eigen::VectorXd::Zero(size),
                              {}};
  if (!arm.points_placed) return covariance;
  const std::vector<metrology::MeasuredLine> lines = axesInR0(axes, arm);
  Eigen::MatrixXd by_axes = Eigen::MatrixXd::Zero(size, static_cast<Eigen::Index>(4 * axes.size()));
  by_axes.topRows(at.wrist_centre) = metrology::derivativesByLines(lines, numbersOf(lines, links));
  covariance.by_scale.segment<3>(FramesLayout::kR0 + 3) = -(arm.r0_from_points * station);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (axes[i].measured && axes[i + 1].measured) {
      covariance.by_scale[FramesLayout::kDistances + row] = links[i].distance;
    } else {
      by_axes.row(FramesLayout::kDistances + row).setZero();
      by_axes.row(at.angles + row).setZero();
    }
  }
  if (wrist.measured) {
    by_axes.middleRows<3>(at.wrist_centre) = metrology::pointByFrameError(wrist.centre_in_r0) * by_axes.topRows<6>();
    covariance.by_scale.segment<3>(at.wrist_centre) = wrist.centre_in_r0;
    for (const int target : wrist.targets) {
      covariance.by_scale[at.radii + target] = wrist.radii[static_cast<std::size_t>(target)];
    }
  }
  covariance.readings = propagated(by_axes, axesCovariance(axes));
  if (wrist.measured) addWrist(wrist, at, covariance.readings);
  return covariance;
}

void stateUncertainties(const FramesCovariance& covariance, const MeasuredAxes& axes, const ArmInR0& arm, Links& links,
                        WristCentre& wrist) {
  if (!arm.points_placed) return;
  const FramesLayout at(static_cast<int>(axes.size()));
  const Eigen::MatrixXd total = covariance.total();
  // Where a joint turns several axes one of them stands where the others leave it, by what the covariance lacks
  // (fitCoupledAxes).
  const robot::ArmAxes& turned = arm.arm.axes_in_base_at_zero;
  const auto standsAlone = [&](std::size_t axis) {
    const int joint = turned.jointOf(static_cast<int>(axis));
    return axes[axis].measured && joint >= 0 && turned.turnsAlone(joint);
  };
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!standsAlone(i) || !standsAlone(i + 1)) continue;
    const auto row = static_cast<Eigen::Index>(i), distance = FramesLayout::kDistances + row, angle = at.angles + row;
    links[i].distance_sd = std::sqrt(total(distance, distance));
    links[i].angle_sd = std::sqrt(total(angle, angle));
    links[i].distance_sag_sd = std::sqrt(covariance.sag(distance, distance));
  }
  for (WristAxesMiss& miss : wrist.misses) {
    miss.sd = links[static_cast<std::size_t>(miss.first)].distance_sd.value_or(0.0);
  }
  if (!wrist.measured) return;
  wrist.covariance = total.block<3, 3>(at.wrist_centre, at.wrist_centre);
  const Eigen::Matrix3d common = wrist.covariance - wrist.spheres.covariance.topLeftCorner<3, 3>() + wrist.by_station;
  Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
  for (const WristTableRow& row : wrist.table) own += row.covariance;
  const auto rows = static_cast<double>(std::max<std::size_t>(1, wrist.table.size()));
  wrist.table_mean_covariance = own / (rows * rows) + common;
}

std::vector<std::optional<Eigen::Vector3d>> targetsAtZero(const campaign::Campaign& campaign, const ArmInR0& arm,
                                                          const RigidPoints& points) {
  std::vector<std::optional<Eigen::Vector3d>> targets(campaign.targets.size());
  for (std::size_t k = 0; k < targets.size(); ++k) {
    if (const auto& declared = campaign.targets[k].position_in_flange) {
      targets[k] = arm.arm.base_from_flange_at_zero * *declared;
    }
  }
  if (!arm.points_placed) return targets;

  std::vector<Eigen::Vector3d> sums(targets.size(), Eigen::Vector3d::Zero());
  std::vector<int> counts(targets.size(), 0);
  const auto add = [&](const auto& rows, const std::vector<Eigen::Vector3d>& rigid) {
    Eigen::Isometry3d zero_from_now = Eigen::Isometry3d::Identity();
    for (std::size_t row = 0; row < rows.size(); ++row) {
      // The reflectors of one stop follow each other.
      if (row == 0 || rows[row].q != rows[row - 1].q)
        zero_from_now = robot::postureAt(arm.arm, rows[row].q).motion.back().inverse();
      const auto k = static_cast<std::size_t>(rows[row].target);
      sums[k] += zero_from_now * (arm.r0_from_points * rigid[row]);
      ++counts[k];
    }
  };
  if (campaign.circle_sweeps) add(campaign.circle_sweeps->rows, points.circle_sweeps);
  if (campaign.wrist_sweep && campaign.wrist_sweep->frame == campaign.circle_sweeps->frame) {
    add(campaign.wrist_sweep->rows, points.wrist_sweep);
  }
  for (std::size_t k = 0; k < targets.size(); ++k) {
    if (counts[k] > 0) targets[k] = sums[k] / counts[k];
  }
  return targets;
}

namespace {

/// Where the last axis pierces the plane z = 0 of the flange, in flange axes; empty where it runs along the plane.
std::optional<Eigen::Vector3d> tcpInFlange(const robot::Robot& arm) {
  const Eigen::Isometry3d flange_from_base = arm.base_from_flange_at_zero.inverse();
  const metrology::Line& last = arm.axes_in_base_at_zero.back();
  const Eigen::Vector3d point = flange_from_base * last.point;
  const Eigen::Vector3d direction = flange_from_base.linear() * last.direction;
  constexpr double kAlong = 0.1736;  // sine of ten degrees: an error of the axis moves the point by six times itself
  if (std::abs(direction.z()) < kAlong) return std::nullopt;
  return point - point.z() / direction.z() * direction;
}

Frames measureOnce(const campaign::Campaign& campaign, const RigidPoints& points) {
  Frames frames;
  frames.largest_sag = points.largest_sag;
  if (campaign.circle_sweeps) frames.points_frame = campaign.circle_sweeps->frame;
  frames.axes = measureAxes(campaign, points);
  frames.arm = armInR0(campaign.robot, frames.axes);
  frames.links = linkGeometry(campaign.robot, frames.arm);
  frames.targets_in_r0_at_zero = targetsAtZero(campaign, frames.arm, points);
  frames.wrist = measureWristCentre(campaign, frames.arm, points, frames.targets_in_r0_at_zero);
  const std::optional<Eigen::Vector3d> tcp = tcpInFlange(frames.arm.arm);
  frames.tcp_in_flange = tcp.value_or(Eigen::Vector3d::Zero());
  frames.tcp_at_origin = !tcp;
  frames.weight = robot::gravityLoad(campaign.robot, campaign.tool, campaign.gravity_in_base, frames.arm.arm,
                                     frames.arm.r0_from_base_link);
  return frames;
}

}  // namespace

Eigen::VectorXd framesDifference(const Frames& from, const Frames& to) {
  const FramesLayout at(from.arm.arm.axes());
  Eigen::VectorXd numbers = Eigen::VectorXd::Zero(at.count(from.targets_in_r0_at_zero.size()));
  numbers.segment<6>(FramesLayout::kR0) =
      metrology::frameError(from.arm.r0_from_points.inverse(), to.arm.r0_from_points.inverse());
  for (std::size_t i = 0; i < from.links.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    numbers[FramesLayout::kDistances + row] = to.links[i].distance - from.links[i].distance;
    numbers[at.angles + row] = to.links[i].angle - from.links[i].angle;
  }
  if (!from.wrist.measured || !to.wrist.measured) return numbers;
  numbers.segment<3>(at.wrist_centre) = to.wrist.centre_in_r0 - from.wrist.centre_in_r0;
  for (const int target : from.wrist.targets) {
    const auto k = static_cast<std::size_t>(target);
    numbers[at.radii + target] = to.wrist.radii[k] - from.wrist.radii[k];
  }
  return numbers;
}

namespace {

SagModel sagOf(const Frames& frames, const robot::GravityLoad& weight, const JointVector& compliance) {
  return SagModel(frames.arm.arm, weight, compliance, frames.targets_in_r0_at_zero,
                  frames.arm.r0_from_points.inverse());
}

/// The part of the covariance that comes from the compliances, by differences of the whole measurement.
std::optional<Eigen::MatrixXd> sagPart(const Frames& frames, const JointVector& compliance,
                                       const JointMatrix& covariance,
                                       const std::function<Frames(const JointVector&)>& measuredWith) {
  if (!frames.arm.points_placed) return std::nullopt;
  constexpr double kStep = 1e-8;  // rad/Nm: a hundredth of a stiff joint's; the sag is linear far beyond it
  const int joints = frames.arm.arm.joints();
  Eigen::MatrixXd by_compliance =
      Eigen::MatrixXd::Zero(FramesLayout(frames.arm.arm.axes()).count(frames.targets_in_r0_at_zero.size()), joints);
  numerics::onAllCores(static_cast<std::size_t>(joints), [&](std::size_t j) {
    const auto joint = static_cast<Eigen::Index>(j);
    if (covariance(joint, joint) == 0.0) return;
    const Frames moved = measuredWith(compliance + kStep * JointVector::Unit(joints, joint));
    if (moved.arm.points_placed) by_compliance.col(joint) = framesDifference(frames, moved) / kStep;
  });
  return propagated(by_compliance, covariance);
}

void propagate(const campaign::Campaign& campaign, Frames& frames,
               const std::optional<Eigen::MatrixXd>& sag = std::nullopt,
               const std::optional<Eigen::VectorXd>& by_masses = std::nullopt) {
  const Eigen::Vector3d station = campaign.tracker ? campaign.tracker->station : Eigen::Vector3d::Zero();
  frames.covariance =
      framesCovariance(frames.axes, frames.arm, frames.links, frames.wrist, campaign.targets.size(), station);
  if (sag) frames.covariance.sag = *sag;
  if (by_masses) frames.covariance.by_masses = *by_masses;
  if (campaign.tracker) frames.covariance.scale_sd = campaign.tracker->scale_sigma;
  stateUncertainties(frames.covariance, frames.axes, frames.arm, frames.links, frames.wrist);
}

}  // namespace

Frames measureFrames(const campaign::Campaign& campaign) {
  Frames frames = measureOnce(campaign, rigidPoints(campaign, SagModel()));
  propagate(campaign, frames);
  frames.sag_note = Remark(frames.weight.links_known ? RemarkId::sag_without_stiffness : RemarkId::sag_without_masses);
  return frames;
}

Frames refineFrames(const campaign::Campaign& campaign, const Frames& so_far, const JointVector& compliance,
                    const std::optional<JointMatrix>& covariance) {
  if (!so_far.weight.links_known) return so_far;
  const auto measuredUnder = [&](const robot::GravityLoad& weight, const JointVector& c) {
    return measureOnce(campaign, rigidPoints(campaign, sagOf(so_far, weight, c)));
  };
  const auto measuredWith = [&](const JointVector& c) { return measuredUnder(so_far.weight, c); };
  Frames frames = measuredWith(compliance);
  frames.sag_removed = true;
  frames.sag_note = Remark(RemarkId::sag_taken_off);
  // `so_far` is of the same sweeps, so that what they give as they were read need not be measured again.
  for (std::size_t i = 0; i < frames.links.size(); ++i) {
    const LinkGeometry& before = so_far.links[i];
    const double as_read = so_far.sag_removed ? before.distance - before.distance_by_sag : before.distance;
    frames.links[i].distance_by_sag = frames.links[i].distance - as_read;
  }
  std::optional<Eigen::VectorXd> by_masses;
  if (campaign.mass_sigma > 0.0 && frames.arm.points_placed) {
    robot::Robot heavier = campaign.robot;
    robot::scaleMasses(1.0 + campaign.mass_sigma, heavier);
    const robot::GravityLoad weight = robot::gravityLoad(heavier, campaign.tool, campaign.gravity_in_base,
                                                         so_far.arm.arm, so_far.arm.r0_from_base_link);
    by_masses = framesDifference(frames, measuredUnder(weight, compliance));
  }
  frames.sag_in_uncertainty = covariance && covariance->allFinite();
  propagate(campaign, frames,
            frames.sag_in_uncertainty ? sagPart(frames, compliance, *covariance, measuredWith) : std::nullopt,
            by_masses);
  return frames;
}

Frames refineByKnownStiffness(const campaign::Campaign& campaign, const Frames& so_far) {
  if (!so_far.weight.links_known || !so_far.arm.points_placed || !campaign.circle_sweeps) return so_far;
  const robot::Robot& arm = so_far.arm.arm;
  const int joints = arm.joints();
  JointVector torque = JointVector::Zero(joints);  // the largest of each
  for (const campaign::CircleReading& reading : campaign.circle_sweeps->rows)
    torque = torque.cwiseMax(robot::weightTorque(arm, robot::postureAt(arm, reading.q), so_far.weight).cwiseAbs());
  JointVector compliance = JointVector::Zero(joints);
  JointMatrix covariance = JointMatrix::Zero(joints, joints);
  bool all_known = true;
  for (int joint = 0; joint < joints; ++joint) {
    const auto known = std::find_if(campaign.known_stiffness.begin(), campaign.known_stiffness.end(),
                                    [&](const campaign::KnownStiffness& one) { return one.joint == joint; });
    constexpr double kFelt = 1.0;  // Nm: a vertical axis carries none
    if (known != campaign.known_stiffness.end()) {
      compliance[joint] = 1.0 / known->stiffness;
      covariance(joint, joint) = std::pow(known->sd / (known->stiffness * known->stiffness), 2);
    } else if (torque[joint] > kFelt) {
      all_known = false;
      covariance(joint, joint) = std::pow(kTurnByOwnWeight / torque[joint], 2);
    }
  }
  Frames frames = refineFrames(campaign, so_far, compliance, covariance);
  frames.sag_in_uncertainty = true;
  frames.sag_removed = !compliance.isZero(0.0);
  frames.sag_note =
      all_known ? Remark(RemarkId::sag_by_known_stiffness) : Remark(RemarkId::sag_allowed_for, kTurnByOwnWeight);
  return frames;
}

SagModel sagOf(const Frames& frames, const JointVector& compliance) { return sagOf(frames, frames.weight, compliance); }

Eigen::VectorXd framesChange(const campaign::Campaign& campaign, const RigidPoints& points, const Frames& frames) {
  return framesDifference(frames, measureOnce(campaign, points));
}

std::optional<Eigen::Isometry3d> r0FromTable(const Frames& frames, campaign::PointFrame table_frame) {
  if (frames.arm.points_placed && table_frame == frames.points_frame) return frames.arm.r0_from_points;
  if (table_frame == campaign::PointFrame::base_link) return frames.arm.r0_from_base_link;
  return std::nullopt;
}

}  // namespace stiffscope::frames
