#include "core/identification/method_runs.h"

#include <utility>

#include "core/frames/joint_axes.h"
#include "core/numerics/parallel.h"
#include "metrology/linear_algebra.h"
#include "metrology/lines.h"

namespace stiffscope::identification {

namespace {

/// What the loading takes from the frames, with axes and radii moved.
class MovedFrames {
 public:
  MovedFrames(const campaign::Campaign& campaign, const frames::Frames& frames, const frames::LoadingGeometry& geometry,
              const std::vector<int>& steps)
      : campaign_(campaign), frames_(frames), compliance_(geometry.compliance), readings_(campaign, steps) {}

  /// `axes`: lines of the axes that are measured, in their order.
  LoadedArm withAxes(const std::vector<metrology::Line>& axes) const {
    frames::Frames moved = frames_;
    std::size_t next = 0;
    for (frames::MeasuredAxis& axis : moved.axes) {
      if (axis.measured) axis.at_zero.line = axes[next++];
    }
    moved.arm = frames::armInR0(campaign_.robot, moved.axes);
    const Eigen::Isometry3d carry = moved.arm.r0_from_points * frames_.arm.r0_from_points.inverse();
    for (std::size_t k = 0; k < moved.targets_in_r0_at_zero.size(); ++k) {
      if (frames_.targets_in_r0_at_zero[k]) moved.targets_in_r0_at_zero[k] = carry * *frames_.targets_in_r0_at_zero[k];
    }
    return load(moved);
  }

  LoadedArm withRadius(std::size_t target, double step) const {
    frames::Frames one = frames_;
    one.wrist.radii[target] += step;
    return load(one);
  }

  LoadedArm unmoved() const { return load(frames_); }

 private:
  LoadedArm load(const frames::Frames& frames) const {
    return loadedArm(campaign_, readings_, frames::sweptGeometry(campaign_, frames, compliance_), frames.wrist,
                     readings_.steps());
  }

  const campaign::Campaign& campaign_;
  const frames::Frames& frames_;
  const JointVector compliance_;
  const LoadReadings readings_;
};

Eigen::VectorXd solveAll(const std::vector<ComplianceOf>& solves, const LoadedArm& arm) {
  const Eigen::Index joints = arm.geometry.arm.joints();
  Eigen::VectorXd all(joints * static_cast<Eigen::Index>(solves.size()));
  for (std::size_t k = 0; k < solves.size(); ++k)
    all.segment(joints * static_cast<Eigen::Index>(k), joints) = solves[k](arm);
  return all;
}

}  // namespace

std::vector<SweptParts> sweptParts(const campaign::Campaign& campaign, const frames::Frames& frames,
                                   const frames::LoadingGeometry& geometry, const std::vector<int>& steps,
                                   const std::vector<ComplianceOf>& solves) {
  const Eigen::Index count = geometry.arm.joints();
  const JointMatrix none = JointMatrix::Zero(count, count);
  std::vector<SweptParts> parts(solves.size(), {none, none});
  if (solves.empty() || !frames.arm.points_placed) return parts;
  const MovedFrames moved(campaign, frames, geometry, steps);
  const frames::AxesCovariance all_axes = frames::axesCovariance(frames.axes);
  std::vector<metrology::MeasuredLine> lines;
  std::vector<Eigen::Index> rows;
  for (std::size_t axis = 0; axis < frames.axes.size(); ++axis) {
    if (!frames.axes[axis].measured) continue;
    lines.push_back(frames.axes[axis].at_zero);
    for (Eigen::Index k = 0; k < 4; ++k) rows.push_back(4 * static_cast<Eigen::Index>(axis) + k);
  }
  const frames::WristCentre& wrist = frames.wrist;
  const std::size_t swept = wrist.measured ? wrist.targets.size() : 0;
  const Eigen::Index joints = geometry.arm.joints(), numbers = joints * static_cast<Eigen::Index>(solves.size());
  Eigen::MatrixXd by_axes(numbers, 4 * static_cast<Eigen::Index>(lines.size()));
  Eigen::MatrixXd with_radii(numbers, static_cast<Eigen::Index>(swept));
  Eigen::VectorXd unmoved;
  constexpr double kStep = 1e-5;  // m
  // Axes, each by itself, then radii, then nothing moved.
  numerics::onAllCores(lines.size() + (swept > 0 ? swept + 1 : 0), [&](std::size_t i) {
    if (i < lines.size()) {
      by_axes.middleCols<4>(4 * static_cast<Eigen::Index>(i)) =
          metrology::derivativesByLines({lines[i]}, [&](const std::vector<metrology::Line>& axis) {
            std::vector<metrology::Line> axes;
            for (const metrology::MeasuredLine& line : lines) axes.push_back(line.line);
            axes[i] = axis.front();
            return solveAll(solves, moved.withAxes(axes));
          });
    } else if (const std::size_t k = i - lines.size(); k < swept) {
      with_radii.col(static_cast<Eigen::Index>(k)) =
          solveAll(solves, moved.withRadius(static_cast<std::size_t>(wrist.targets[k]), kStep));
    } else {
      unmoved = solveAll(solves, moved.unmoved());
    }
  });
  const Eigen::MatrixXd of_axes = all_axes(rows, rows);
  const Eigen::MatrixXd by_radii =
      swept > 0 ? Eigen::MatrixXd((with_radii.colwise() - unmoved) / kStep) : std::move(with_radii);
  const auto radii = static_cast<Eigen::Index>(swept);
  for (std::size_t k = 0; k < solves.size(); ++k) {
    const Eigen::Index at = joints * static_cast<Eigen::Index>(k);
    parts[k].frames = propagated(by_axes.middleRows(at, joints), of_axes);
    if (swept == 0) continue;
    parts[k].wrist = by_radii.middleRows(at, joints) * wrist.spheres.covariance.bottomRightCorner(radii, radii) *
                     by_radii.middleRows(at, joints).transpose();
  }
  return parts;
}

JointMatrix calibratedPart(const campaign::Campaign& campaign, const frames::GeometryCalibration& calibration,
                           const frames::WristCentre& wrist, const std::vector<int>& steps, const ComplianceOf& solve) {
  const LoadReadings readings(campaign, steps);
  const JointVector unmoved = solve(loadedArm(campaign, readings, calibration.geometry, wrist, steps));
  std::vector<JointVector> changes(calibration.spread.size());
  numerics::onAllCores(changes.size(), [&](std::size_t i) {
    changes[i] = solve(loadedArm(campaign, readings, calibration.spread[i], wrist, steps)) - unmoved;
  });
  JointMatrix covariance = JointMatrix::Zero(unmoved.size(), unmoved.size());
  for (const JointVector& change : changes) covariance += change * change.transpose();
  return covariance;
}

}  // namespace stiffscope::identification
