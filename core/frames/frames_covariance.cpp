#include "core/frames/frames_covariance.h"

#include <algorithm>
#include <cmath>

#include "metrology/base_frame.h"
#include "metrology/common_perpendicular.h"
#include "metrology/line_derivatives.h"
#include "metrology/line_pair_uncertainty.h"

namespace stiffscope {

namespace {

using Layout = FramesCovariance;
constexpr Eigen::Index kOfAxes = Layout::kWristCentre;  // numbers that depend on the axes alone

/// The axes at zero, in R0 as it is measured; those that are not measured stand there without uncertainty.
std::vector<MeasuredLine> axesInR0(const std::array<MeasuredAxis, 6>& axes, const ArmInR0& arm) {
  std::vector<MeasuredLine> lines;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    MeasuredLine line;
    if (axes[i].measured) {
      line = axes[i].at_zero;
      line.line = {arm.r0_from_points * line.line.point, arm.r0_from_points.linear() * line.line.direction};
      line.across_u = arm.r0_from_points.linear() * line.across_u;
      line.across_v = arm.r0_from_points.linear() * line.across_v;
    } else {
      line.line = arm.arm.axes_in_base_at_zero[i];
      basisAcross(line.line.direction, line.across_u, line.across_v);
    }
    lines.push_back(line);
  }
  return lines;
}

Line directedAlong(const Eigen::Vector3d& direction, Line line) {
  if (line.direction.dot(direction) < 0.0) line.direction = -line.direction;
  return line;
}

/// Error of R0, distances and angles, as they follow from the axes; smooth where distances and angles are zero.
LineNumbers numbersOf(const std::vector<MeasuredLine>& axes, const std::array<LinkGeometry, 5>& links) {
  std::vector<LinePairNumber> distances, angles;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const MeasuredLine &first = axes[i], &second = axes[i + 1];
    distances.push_back(links[i].near_parallel ? LinePairNumber() : signedDistance(first.line, second.line));
    // Exactly parallel axes, as only drawings have them, tilt about any normal.
    angles.push_back(tiltAbout(commonNormal(first.line, second.line).value_or(first.across_u)));
  }
  return [distances, angles](const std::vector<Line>& moved) {
    Eigen::VectorXd numbers(kOfAxes);
    const Eigen::Isometry3d r0 = baseFrame(directedAlong(Eigen::Vector3d::UnitZ(), moved[0]),
                                           directedAlong(Eigen::Vector3d::UnitY(), moved[1]));
    numbers.segment<6>(Layout::kR0) = frameError(Eigen::Isometry3d::Identity(), r0);
    std::array<Line, 6> lines;
    std::copy(moved.begin(), moved.end(), lines.begin());
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      numbers[Layout::kDistances + row] =
          distances[i] ? distances[i](lines[i], lines[i + 1])
                       : distanceAcross(lines[i], lines[i + 1], hayatiPoint(lines, i));
      numbers[Layout::kAngles + row] = angles[i](lines[i], lines[i + 1]);
    }
    return numbers;
  };
}

void addWrist(const WristCentre& wrist, Eigen::MatrixXd& covariance) {
  const auto place = [&](Eigen::Index i) {
    return i < 3 ? Layout::kWristCentre + i : Layout::kRadii + wrist.targets[static_cast<std::size_t>(i - 3)];
  };
  const Eigen::MatrixXd& own = wrist.spheres.covariance;
  for (Eigen::Index i = 0; i < own.rows(); ++i) {
    for (Eigen::Index j = 0; j < own.cols(); ++j) covariance(place(i), place(j)) += own(i, j);
  }
}

}  // namespace

Eigen::MatrixXd FramesCovariance::total(double scale_sd) const {
  return readings + sag + scale_sd * scale_sd * by_scale * by_scale.transpose();
}

FramesCovariance framesCovariance(const std::array<MeasuredAxis, 6>& axes, const ArmInR0& arm,
                                  const std::array<LinkGeometry, 5>& links, const WristCentre& wrist,
                                  std::size_t targets, const Eigen::Vector3d& station) {
  const Eigen::Index size = Layout::kRadii + static_cast<Eigen::Index>(targets);
  FramesCovariance covariance{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, size),
                              Eigen::VectorXd::Zero(size)};
  if (!arm.points_placed) return covariance;
  const std::vector<MeasuredLine> lines = axesInR0(axes, arm);
  Eigen::MatrixXd by_axes = Eigen::MatrixXd::Zero(size, 24);
  by_axes.topRows(kOfAxes) = derivativesByLines(lines, numbersOf(lines, links));
  covariance.by_scale.segment<3>(Layout::kR0 + 3) = -(arm.r0_from_points * station);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (axes[i].measured && axes[i + 1].measured) {
      covariance.by_scale[Layout::kDistances + row] = links[i].distance;
    } else {
      by_axes.row(Layout::kDistances + row).setZero();
      by_axes.row(Layout::kAngles + row).setZero();
    }
  }
  if (wrist.measured) {
    by_axes.middleRows<3>(Layout::kWristCentre) =
        pointByFrameError(wrist.centre_in_r0) * by_axes.topRows<6>();
    covariance.by_scale.segment<3>(Layout::kWristCentre) = wrist.centre_in_r0;
    for (const int target : wrist.targets) {
      covariance.by_scale[Layout::kRadii + target] = wrist.radii[static_cast<std::size_t>(target)];
    }
  }
  covariance.readings = by_axes * axesCovariance(axes) * by_axes.transpose();
  if (wrist.measured) addWrist(wrist, covariance.readings);
  return covariance;
}

void stateUncertainties(const FramesCovariance& covariance, const std::array<MeasuredAxis, 6>& axes,
                        const ArmInR0& arm, std::array<LinkGeometry, 5>& links, WristCentre& wrist) {
  if (!arm.points_placed) return;
  const Eigen::MatrixXd total = covariance.total();
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!axes[i].measured || !axes[i + 1].measured) continue;
    const auto row = static_cast<Eigen::Index>(i), distance = Layout::kDistances + row, angle = Layout::kAngles + row;
    links[i].distance_sd = std::sqrt(total(distance, distance));
    links[i].angle_sd = std::sqrt(total(angle, angle));
    links[i].distance_sag_sd = std::sqrt(covariance.sag(distance, distance));
  }
  wrist.miss_45_sd = links[3].distance_sd.value_or(0.0);
  wrist.miss_56_sd = links[4].distance_sd.value_or(0.0);
  if (!wrist.measured) return;
  wrist.covariance = total.block<3, 3>(Layout::kWristCentre, Layout::kWristCentre);
  const Eigen::Matrix3d common = wrist.covariance - wrist.spheres.covariance.topLeftCorner<3, 3>();
  Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
  for (const WristTableRow& row : wrist.table) own += row.covariance;
  const auto rows = static_cast<double>(std::max<std::size_t>(1, wrist.table.size()));
  wrist.table_mean_covariance = own / (rows * rows) + common;
}

}  // namespace stiffscope
