#include "core/calibration/fitted_day.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/numerics/parallel.h"
#include "core/robot/kinematics.h"
#include "metrology/rigid_motion.h"

namespace stiffscope::calibration {

FittedDay::FittedDay(const UnloadedDay& day, const ArmFit& fit)
    : day_(day),
      fit_(fit),
      arm_(fit.start, fit.centre, fit.steps.head(fit.places().axes()),
           fit.steps.segment<frames::ArmParameters::kBase>(fit.places().baseAt())) {
  for (const EffectPart& part : fit.parts) {
    for (const EffectTerm& term : part.terms) terms_.push_back(&term);
  }
  for (const EffectTerm& term : fit.stations) terms_.push_back(&term);
}

AnglesByTerms FittedDay::anglesByTerms(const Posture& posture) const {
  AnglesByTerms angles = AnglesByTerms::Zero(posture.q.size(), static_cast<Eigen::Index>(terms_.size()));
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    if (terms_[k]->angles) angles.col(static_cast<Eigen::Index>(k)) = terms_[k]->angles(posture);
  }
  return angles;
}

ReflectorAt FittedDay::reflector(const frames::PlacedPosture& placed, const Reading& reading) const {
  const auto target = static_cast<std::size_t>(reading.target);
  const Eigen::Vector3d at_zero =
      fit_.place.targets_at_zero[target] + fit_.steps.segment<3>(fit_.places().targetAt(target));
  return {placed, reading.target, placed.position(at_zero), fit_.place.base_from_points * day_.stationOf(reading),
          reading.place};
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
  // Cholesky's factor of three rows and its inverse, written out: this is done for every reading in every turn of a
  // fit.
  const double l00 = std::sqrt(covariance(0, 0));
  const double l10 = covariance(1, 0) / l00, l20 = covariance(2, 0) / l00;
  const double l11 = std::sqrt(covariance(1, 1) - l10 * l10);
  const double l21 = (covariance(2, 1) - l20 * l10) / l11;
  const double l22 = std::sqrt(covariance(2, 2) - l20 * l20 - l21 * l21);
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  inverse(0, 0) = 1.0 / l00;
  inverse(1, 1) = 1.0 / l11;
  inverse(2, 2) = 1.0 / l22;
  inverse(1, 0) = -l10 * inverse(0, 0) * inverse(1, 1);
  inverse(2, 1) = -l21 * inverse(1, 1) * inverse(2, 2);
  inverse(2, 0) = -(l20 * inverse(0, 0) + l21 * inverse(1, 0)) * inverse(2, 2);
  return inverse;
}

ReadingDerivatives::ReadingDerivatives(const FittedDay& fitted, const std::vector<int>& places)
    : fitted_(fitted), motions_(6, places.size()), rows_(3, places.size()) {
  motions_.setZero();
  const auto steps = static_cast<std::size_t>(fitted.fit().steps.size());
  const auto base_at = static_cast<std::size_t>(fitted.fit().places().baseAt()),
             targets_at = static_cast<std::size_t>(fitted.fit().places().targetsAt());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    if (places[k] < 0) {
      read_.push_back({column, static_cast<std::size_t>(-1 - places[k])});
      continue;
    }
    const auto place = static_cast<std::size_t>(places[k]);
    if (place < base_at) {
      axes_.push_back({column, place});
    } else if (place < targets_at) {
      const frames::SmallMotion motion = fitted.arm().byBase(place - base_at);
      motions_.col(column) << motion.rotation, motion.shift;
    } else if (place < steps) {
      targets_.push_back({column, place - targets_at});
    } else {
      (fitted.terms()[place - steps]->angles ? angles_ : offsets_).push_back({column, place - steps});
    }
  }
}

void ReadingDerivatives::enter(const frames::PlacedPosture& placed, const Eigen::Ref<const AnglesByTerms>& by_terms) {
  for (const Place& axis : axes_) {
    const frames::SmallMotion& motion = placed.beyondAxis(axis.of);
    motions_.col(axis.column) << motion.rotation, motion.shift;
  }
  if (angles_.empty()) return;
  Jacobian by_joints(6, by_terms.rows());
  for (std::size_t j = 0; j < static_cast<std::size_t>(by_joints.cols()); ++j) {
    const frames::SmallMotion motion = placed.byJoint(j);
    by_joints.col(static_cast<Eigen::Index>(j)) << motion.rotation, motion.shift;
  }
  // In every turn of a fit, in every posture, for every term: at fixed size where there are six.
  const bool six = by_joints.cols() == 6;
  for (const Place& term : angles_) {
    const auto angles = by_terms.col(static_cast<Eigen::Index>(term.of));
    if (six) {
      motions_.col(term.column) = (by_joints.leftCols<6>() * angles.head<6>()).array();
    } else {
      motions_.col(term.column) = (by_joints * angles).array();
    }
  }
}

const ReadingDerivatives::Rows& ReadingDerivatives::of(const Posture& posture, const ReflectorAt& at,
                                                       const Eigen::Matrix3d& whitening) {
  const double x = at.position.x(), y = at.position.y(), z = at.position.z();
  // The whitening is lower triangular.
  const double w00 = whitening(0, 0), w10 = whitening(1, 0), w11 = whitening(1, 1), w20 = whitening(2, 0),
               w21 = whitening(2, 1), w22 = whitening(2, 2);
  const Eigen::Index count = rows_.cols();
  const double* motions = motions_.data();
  double* rows = rows_.data();
  // Of all parameters at once, and all of a parameter at once: most of a fit's time would go into writing and reading.
  for (Eigen::Index k = 0; k < count; ++k) {
    const double turn_x = motions[k], turn_y = motions[count + k], turn_z = motions[2 * count + k];
    const double by_x = turn_y * z - turn_z * y + motions[3 * count + k];
    const double by_y = turn_z * x - turn_x * z + motions[4 * count + k];
    const double by_z = turn_x * y - turn_y * x + motions[5 * count + k];
    rows[k] = w00 * by_x;
    rows[count + k] = w10 * by_x + w11 * by_y;
    rows[2 * count + k] = w20 * by_x + w21 * by_y + w22 * by_z;
  }
  const Eigen::Matrix3d by_target = whitening * at.arm.byTarget();
  for (const Place& target : targets_) {
    if (target.of / 3 == static_cast<std::size_t>(at.target))
      rows_.col(target.column) = by_target.col(static_cast<Eigen::Index>(target.of % 3));
  }
  for (const Place& target : read_) rows_.col(target.column) = by_target.col(static_cast<Eigen::Index>(target.of));
  for (const Place& term : offsets_)
    rows_.col(term.column).noalias() = whitening * fitted_.terms()[term.of]->offset(posture, at);
  return rows_;
}

std::vector<Eigen::Vector3d> residualsOf(const UnloadedDay& day, const ArmFit& fit) {
  return residualsOf(day, fit, std::vector<double>(day.readings(), 1.0));
}

std::vector<Eigen::Vector3d> residualsOf(const UnloadedDay& day, const ArmFit& fit,
                                         const std::vector<double>& weights) {
  const FittedDay fitted(day, fit);
  std::vector<std::size_t> first;
  first.reserve(day.postures.size());
  std::size_t readings = 0;
  for (const Posture& posture : day.postures) {
    first.push_back(readings);
    readings += posture.readings.size();
  }
  std::vector<Eigen::Vector3d> residuals(readings, Eigen::Vector3d::Zero());
  numerics::smallWorkOnAllCores(day.postures.size(), [&](std::size_t i) {
    const Posture& posture = day.postures[i];
    const auto own = weights.begin() + static_cast<std::ptrdiff_t>(first[i]);
    if (std::all_of(own, own + static_cast<std::ptrdiff_t>(posture.readings.size()), [](double w) { return w == 0.0; }))
      return;
    const frames::PlacedPosture placed(fitted.arm(), fitted.anglesOf(posture));
    for (std::size_t k = 0; k < posture.readings.size(); ++k) {
      const Reading& reading = posture.readings[k];
      residuals[first[i] + k] = fitted.residual(posture, reading, fitted.reflector(placed, reading));
    }
  });
  return residuals;
}

PostureEquations equationsOf(const UnloadedDay& day, const ArmFit& fit, std::size_t i, std::size_t first_reading) {
  return equationsOf(FittedDay(day, fit), day.postures[i], first_reading);
}

PostureEquations equationsOf(const FittedDay& fitted, const Posture& posture, std::size_t first_reading) {
  const ArmFit& fit = fitted.fit();
  const AnglesByTerms by_terms = fitted.anglesByTerms(posture);
  const frames::PlacedPosture placed(fitted.arm(), fitted.anglesOf(posture, by_terms));
  ReadingDerivatives derivatives(fitted, fit.free);
  derivatives.enter(placed, by_terms);
  PostureEquations equations;
  const auto rows = 3 * static_cast<Eigen::Index>(posture.readings.size());
  equations.by_parameters.resize(rows, static_cast<Eigen::Index>(fit.free.size()));
  equations.by_angles.resize(rows, posture.q.size());
  equations.by_motion.resize(rows, 6);
  equations.residual.resize(rows);
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < posture.readings.size(); ++k) {
    if (fit.weights[first_reading + k] <= 0.0) continue;
    const Reading& reading = posture.readings[k];
    const ReflectorAt at = fitted.reflector(placed, reading);
    const Eigen::Matrix3d white = fitted.whitening(reading);
    equations.by_parameters.middleRows<3>(row) = derivatives.of(posture, at, white);
    equations.by_angles.middleRows<3>(row) = white * placed.byAngles(at.position);
    equations.by_motion.block<3, 3>(row, 0) = -white * metrology::crossMatrix(at.position);
    equations.by_motion.block<3, 3>(row, 3) = white;
    equations.residual.segment<3>(row) = white * fitted.residual(posture, reading, at);
    equations.targets.push_back(reading.target);
    equations.whitening.push_back(white);
    equations.positions.push_back(at.position);
    equations.stations.push_back(at.station);
    equations.places.push_back(at.place);
    row += 3;
  }
  equations.by_parameters.conservativeResize(row, Eigen::NoChange);
  equations.by_angles.conservativeResize(row, Eigen::NoChange);
  equations.by_motion.conservativeResize(row, Eigen::NoChange);
  equations.residual.conservativeResize(row);
  return equations;
}

Eigen::MatrixXd columnsOf(const FittedDay& fitted, const Posture& posture, const PostureEquations& equations,
                          const std::vector<EffectTerm>& terms) {
  Eigen::MatrixXd columns(equations.residual.size(), static_cast<Eigen::Index>(terms.size()));
  std::optional<frames::PlacedPosture> placed;  // only what moves reflectors asks for it
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    if (terms[k].angles) {
      columns.col(column).noalias() = equations.by_angles * terms[k].angles(posture);
      continue;
    }
    if (!placed) placed.emplace(fitted.arm(), fitted.anglesOf(posture));
    for (std::size_t r = 0; r < equations.targets.size(); ++r) {
      const ReflectorAt at{*placed, equations.targets[r], equations.positions[r], equations.stations[r],
                           equations.places[r]};
      columns.col(column).segment<3>(3 * static_cast<Eigen::Index>(r)).noalias() =
          equations.whitening[r] * terms[k].offset(posture, at);
    }
  }
  return columns;
}

}  // namespace stiffscope::calibration
