#include "core/calibration/fitted_day.h"

#include <Eigen/Dense>

#include "core/robot/kinematics.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::calibration {

using frames::ArmParameters;

FittedDay::FittedDay(const UnloadedDay& day, const ArmFit& fit)
    : fit_(fit),
      arm_(fit.start, fit.centre, fit.steps.head<ArmParameters::kAxes>(),
           fit.steps.segment<ArmParameters::kBase>(ArmParameters::kBaseAt)),
      station_(fit.place.base_from_points * day.station) {
  for (const EffectPart& part : fit.parts) {
    for (const EffectTerm& term : part.terms) terms_.push_back(&term);
  }
}

Vector6d FittedDay::anglesOf(const Posture& posture) const {
  Vector6d q = posture.q;
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    if (terms_[k]->angles) q += fit_.sizes[static_cast<Eigen::Index>(k)] * terms_[k]->angles(posture);
  }
  return q;
}

ReflectorAt FittedDay::reflector(const frames::PlacedPosture& placed, const Reading& reading) const {
  const auto target = static_cast<std::size_t>(reading.target);
  const Eigen::Vector3d at_zero =
      fit_.place.targets_at_zero[target] + fit_.steps.segment<3>(ArmParameters::targetAt(target));
  return {placed, reading.target, placed.position(at_zero), station_};
}

Eigen::Vector3d FittedDay::residual(const Posture& posture, const Reading& reading, const ReflectorAt& at) const {
  Eigen::Vector3d modelled = at.position;
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const double size = fit_.sizes[static_cast<Eigen::Index>(k)];
    if (terms_[k]->offset && size != 0.0) modelled += size * terms_[k]->offset(posture, at);
  }
  return fit_.place.base_from_points * reading.point - modelled;
}

Eigen::Matrix3d FittedDay::whitening(const Reading& reading) const {
  const Eigen::Matrix3d& turn = fit_.place.base_from_points.linear();
  const Eigen::Matrix3d covariance =
      turn * reading.covariance * turn.transpose() + fit_.model_sd * fit_.model_sd * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d lower = covariance.llt().matrixL();
  return lower.triangularView<Eigen::Lower>().solve(Eigen::Matrix3d::Identity());
}

void FittedDay::derivatives(const Posture& posture, const frames::PlacedPosture& placed, const ReflectorAt& at,
                            bool axes, Eigen::Ref<Eigen::MatrixXd> columns) const {
  columns.setZero();
  if (axes) columns.leftCols<ArmParameters::kAxes>() = placed.byAxes(at.position);
  columns.middleCols<ArmParameters::kBase>(ArmParameters::kBaseAt) = placed.byBase(at.position);
  columns.middleCols<3>(ArmParameters::targetAt(static_cast<std::size_t>(at.target))) = placed.byTarget();
  if (terms_.empty()) return;
  const Matrix36d by_angles = placed.byAngles(at.position);
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const Eigen::Index column = fit_.steps.size() + static_cast<Eigen::Index>(k);
    columns.col(column) =
        terms_[k]->angles ? Eigen::Vector3d(by_angles * terms_[k]->angles(posture)) : terms_[k]->offset(posture, at);
  }
}

std::vector<Eigen::Vector3d> residualsOf(const UnloadedDay& day, const ArmFit& fit) {
  const FittedDay fitted(day, fit);
  std::vector<Eigen::Vector3d> residuals;
  residuals.reserve(day.readings());
  for (const Posture& posture : day.postures) {
    const frames::PlacedPosture placed(fitted.arm(), fitted.anglesOf(posture));
    for (const Reading& reading : posture.readings)
      residuals.push_back(fitted.residual(posture, reading, fitted.reflector(placed, reading)));
  }
  return residuals;
}

PostureEquations equationsOf(const UnloadedDay& day, const ArmFit& fit, std::size_t i, std::size_t first_reading) {
  const FittedDay fitted(day, fit);
  const Posture& posture = day.postures[i];
  const frames::PlacedPosture placed(fitted.arm(), fitted.anglesOf(posture));
  PostureEquations equations;
  const auto rows = 3 * static_cast<Eigen::Index>(posture.readings.size());
  const Eigen::Index all = fit.steps.size() + fit.sizes.size();
  equations.by_parameters.resize(rows, static_cast<Eigen::Index>(fit.free.size()));
  equations.by_angles.resize(rows, 6);
  equations.by_motion.resize(rows, 6);
  equations.residual.resize(rows);
  Eigen::MatrixXd columns(3, all);
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < posture.readings.size(); ++k) {
    if (fit.weights[first_reading + k] <= 0.0) continue;
    const Reading& reading = posture.readings[k];
    const ReflectorAt at = fitted.reflector(placed, reading);
    const Eigen::Matrix3d white = fitted.whitening(reading);
    fitted.derivatives(posture, placed, at, true, columns);
    equations.by_parameters.middleRows<3>(row) = white * columns(Eigen::all, fit.free);
    equations.by_angles.middleRows<3>(row) = white * placed.byAngles(at.position);
    equations.by_motion.block<3, 3>(row, 0) = -white * metrology::crossMatrix(at.position);
    equations.by_motion.block<3, 3>(row, 3) = white;
    equations.residual.segment<3>(row) = white * fitted.residual(posture, reading, at);
    equations.targets.push_back(reading.target);
    equations.whitening.push_back(white);
    equations.positions.push_back(at.position);
    row += 3;
  }
  equations.by_parameters.conservativeResize(row, Eigen::NoChange);
  equations.by_angles.conservativeResize(row, Eigen::NoChange);
  equations.by_motion.conservativeResize(row, Eigen::NoChange);
  equations.residual.conservativeResize(row);
  return equations;
}

Eigen::MatrixXd columnsOf(const UnloadedDay& day, const ArmFit& fit, std::size_t i, const PostureEquations& equations,
                          const std::vector<EffectTerm>& terms) {
  const FittedDay fitted(day, fit);
  const Posture& posture = day.postures[i];
  const frames::PlacedPosture placed(fitted.arm(), fitted.anglesOf(posture));
  Eigen::MatrixXd columns(equations.residual.size(), static_cast<Eigen::Index>(terms.size()));
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    if (terms[k].angles) {
      columns.col(column) = equations.by_angles * terms[k].angles(posture);
      continue;
    }
    for (std::size_t r = 0; r < equations.targets.size(); ++r) {
      const ReflectorAt at{placed, equations.targets[r], equations.positions[r], fitted.station()};
      columns.col(column).segment<3>(3 * static_cast<Eigen::Index>(r)) =
          equations.whitening[r] * terms[k].offset(posture, at);
    }
  }
  return columns;
}

}  // namespace stiffscope::calibration
