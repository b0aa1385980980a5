#include "core/planning/unloaded_plan.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/calibration/arm_fit.h"
#include "core/numerics/parallel.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::planning {

using calibration::EffectPart;
using calibration::UnloadedEffect;
using frames::ArmParameters;

namespace {

/// Effects of the posture alone: own weight, gears once and twice a turn, ratios.
std::vector<EffectPart> steadyParts(const calibration::UnloadedDay& day) {
  std::vector<EffectPart> parts = calibration::jointCompliances(day);
  std::erase_if(parts, [](const EffectPart& part) { return part.detail == "joint 1"; });  // its axis is upright
  for (int joint = 0; joint < day.arm.joints(); ++joint) {
    for (const double order : {1.0, 2.0}) parts.push_back(calibration::transmissionError(joint, order));
  }
  for (const calibration::EffectFamily& family : calibration::effectFamilies(day)) {
    if (family.effect != UnloadedEffect::ratio_error) continue;
    for (const EffectPart& part : family.parts) {
      if (part.detail.rfind("joints", 0) != 0) parts.push_back(part);  // of a joint's own angle
    }
  }
  return parts;
}

/// Effects of where the joint came from and of when: each in the form with the fewest terms.
std::vector<EffectPart> orderedParts(const calibration::UnloadedDay& day) {
  std::vector<EffectPart> parts;
  for (const calibration::EffectFamily& family : calibration::effectFamilies(day)) {
    switch (family.effect) {
      case UnloadedEffect::backlash:
        // By the side that each joint came from.
        parts.insert(parts.end(), family.parts.begin(), family.parts.begin() + day.arm.joints());
        break;
      case UnloadedEffect::read_back_error:
      case UnloadedEffect::tracker_drift:
      case UnloadedEffect::thermal_growth:
      case UnloadedEffect::scale_error:
        parts.push_back(family.wholes.front());
        break;
      default:
        break;
    }
  }
  return parts;
}

Eigen::Index termsOf(const std::vector<EffectPart>& parts) {
  Eigen::Index terms = 0;
  for (const EffectPart& part : parts) terms += static_cast<Eigen::Index>(part.terms.size());
  return terms;
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& normal) {
  return solveSymmetric(normal, Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
}

}  // namespace

UnloadedInformation::UnloadedInformation(const campaign::Campaign& campaign, const PlanningArm& arm,
                                         const std::vector<JointVector>& workspace)
    : arm_(arm) {
  day_.robot = arm.geometry.arm;
  // The planned arm stands where it is calibrated; the masses stay those of the URDF.
  day_.gravity_in_base = campaign.gravity_in_base;
  day_.tool = campaign.tool;
  day_.loading.emplace();
  day_.states.emplace();
  if (campaign.tracker) day_.tracker = campaign.tracker;
  if (!day_.tracker) day_.tracker = campaign::Tracker{"", arm.sigma, 0.0, arm.sigma, 0.0, Eigen::Vector3d::Zero()};
  const Eigen::Isometry3d& flange = day_.robot.base_from_flange_at_zero;
  constexpr double kUsualDistance = 4.0;  // m
  day_.tracker->station = arm.station.value_or(Eigen::Vector3d(kUsualDistance, 0.0, 0.0));
  for (std::size_t t = 0; t < arm.targets_in_flange.size(); ++t) {
    day_.targets.push_back({"P" + std::to_string(t + 1), std::nullopt});
    fit_.place.targets_at_zero.push_back(flange * arm.targets_in_flange[t]);
  }
  const calibration::UnloadedDay empty = calibration::unloadedDay(day_);
  fit_.start = frames::axesAtStart(day_.robot.axes_in_base_at_zero);
  fit_.centre = flange.translation();
  fit_.parts = steadyParts(empty);
  geometry_ = ArmParameters(day_.robot.axes()).count(arm.targets_in_flange.size());
  steady_ = geometry_ + termsOf(fit_.parts);
  for (EffectPart& part : orderedParts(empty)) fit_.parts.push_back(std::move(part));
  all_ = geometry_ + termsOf(fit_.parts);
  fit_.steps = Eigen::VectorXd::Zero(geometry_);
  fit_.sizes = Eigen::VectorXd::Zero(all_ - geometry_);
  fit_.model_sd = arm.misfit;
  for (int k = 0; k < static_cast<int>(all_); ++k) fit_.free.push_back(k);
  setPrior(workspace);
}

calibration::UnloadedDay UnloadedInformation::dayOf(const std::vector<JointVector>& sequence) const {
  campaign::Campaign day = day_;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    day.pose_ids.push_back(std::to_string(i));
    campaign::State state(day_.robot.joints());
    state.pose = static_cast<int>(i);
    state.q = sequence[i];
    day.states->rows.push_back(state);
    const Eigen::Isometry3d motion = robot::postureAt(day.robot, sequence[i]).motion.back();
    for (std::size_t t = 0; t < fit_.place.targets_at_zero.size(); ++t) {
      campaign::LoadingReading reading;
      reading.pose = static_cast<int>(i);
      reading.target = static_cast<int>(t);
      reading.point = motion * fit_.place.targets_at_zero[t];
      day.loading->rows.push_back(reading);
    }
  }
  calibration::UnloadedDay unloaded = calibration::unloadedDay(day);
  for (calibration::Posture& posture : unloaded.postures) {
    for (calibration::Reading& reading : posture.readings) reading.covariance /= arm_.repeats;
  }
  return unloaded;
}

std::vector<Eigen::MatrixXd> UnloadedInformation::allRows(const std::vector<JointVector>& sequence) const {
  const calibration::UnloadedDay day = dayOf(sequence);
  calibration::ArmFit fit = fit_;
  fit.weights.assign(day.readings(), 1.0);
  const std::size_t each = fit_.place.targets_at_zero.size();
  std::vector<Eigen::MatrixXd> rows(day.postures.size());
  numerics::onAllCores(rows.size(),
                       [&](std::size_t i) { rows[i] = calibration::equationsOf(day, fit, i, i * each).by_parameters; });
  return rows;
}

std::vector<Eigen::MatrixXd> UnloadedInformation::rowsOf(const std::vector<JointVector>& postures) const {
  std::vector<Eigen::MatrixXd> rows = allRows(postures);
  for (Eigen::MatrixXd& one : rows) one = Eigen::MatrixXd(one.leftCols(steady_));
  return rows;
}

void UnloadedInformation::setPrior(const std::vector<JointVector>& workspace) {
  const calibration::UnloadedDay day = dayOf(workspace);
  calibration::UnloadedDay plain = day;
  for (calibration::Posture& posture : plain.postures) {
    for (calibration::Reading& reading : posture.readings) reading.covariance.setZero();
  }
  calibration::ArmFit fit = fit_;
  fit.model_sd = 1.0;  // metres: equations as they are
  fit.weights.assign(plain.readings(), 1.0);
  const std::size_t each = fit_.place.targets_at_zero.size();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(all_, all_);
  for (std::size_t i = 0; i < plain.postures.size(); ++i) {
    const Eigen::MatrixXd rows = calibration::equationsOf(plain, fit, i, i * each).by_parameters;
    sum.noalias() += rows.transpose() * rows;
  }
  sum /= static_cast<double>(std::max<std::size_t>(1, plain.readings()));
  workspace_ = sum.topLeftCorner(steady_, steady_);
  prior_ = Eigen::VectorXd::Ones(all_);
  usual_ = Eigen::VectorXd::Ones(all_);
  for (Eigen::Index k = 0; k < ArmParameters(day_.robot.axes()).axes(); ++k) {
    const double sd = k % ArmParameters::kOfAxis < 2 ? calibration::kAxisShiftPrior : calibration::kAxisTiltPrior;
    prior_[k] = 1.0 / (sd * sd);
  }
  for (Eigen::Index k = geometry_; k < all_; ++k) {
    usual_[k] = kUsualEffect / std::sqrt(std::max(1e-30, sum(k, k)));
    prior_[k] = 1.0 / (usual_[k] * usual_[k]);
  }
}

double UnloadedInformation::orderValue(const std::vector<JointVector>& sequence,
                                       const Eigen::MatrixXd& steady_inverse) const {
  const Eigen::Index ordered = all_ - steady_;
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(ordered, ordered), across = Eigen::MatrixXd::Zero(steady_, ordered);
  for (const Eigen::MatrixXd& one : allRows(sequence)) {
    const auto columns = one.rightCols(ordered);
    own.noalias() += columns.transpose() * columns;
    across.noalias() += one.leftCols(steady_).transpose() * columns;
  }
  own -= across.transpose() * steady_inverse * across;
  const Eigen::VectorXd usual = usual_.tail(ordered);
  own = (usual.asDiagonal() * own * usual.asDiagonal()).eval();
  own += Eigen::MatrixXd::Identity(ordered, ordered);
  return 2.0 * choleskyLower(own).diagonal().array().log().sum();
}

UnloadedSight UnloadedInformation::sightOf(const std::vector<JointVector>& sequence, bool details) const {
  UnloadedSight sight;
  const std::vector<Eigen::MatrixXd> rows = allRows(sequence);
  const Eigen::MatrixXd prior = prior_.asDiagonal();
  Eigen::MatrixXd normal = prior;
  const auto rms = [&](const Eigen::MatrixXd& covariance) {
    return std::sqrt(std::max(0.0, covariance.topLeftCorner(steady_, steady_).cwiseProduct(workspace_).sum()));
  };
  for (const Eigen::MatrixXd& one : rows) {
    normal.noalias() += one.transpose() * one;
    if (details) sight.predicted_after.push_back(rms(inverse(normal)));
  }
  const Eigen::MatrixXd covariance = inverse(normal);
  sight.predicted = rms(covariance);
  const Eigen::MatrixXd of_geometry = inverse(normal.topLeftCorner(geometry_, geometry_));
  sight.predicted_geometry =
      std::sqrt(std::max(0.0, of_geometry.cwiseProduct(workspace_.topLeftCorner(geometry_, geometry_)).sum()));
  if (details) {
    for (const Eigen::MatrixXd& one : rows) {
      const double without = rms(inverse(normal - one.transpose() * one));
      sight.gain.push_back(without * without / (sight.predicted * sight.predicted) - 1.0);
    }
  }
  Eigen::Index at = geometry_;
  for (const EffectPart& part : fit_.parts) {
    const auto count = static_cast<Eigen::Index>(part.terms.size());
    // Information on the part with everything else free, without its own prior.
    const Eigen::VectorXd usual = usual_.segment(at, count);
    const Eigen::MatrixXd scaled =
        usual.cwiseInverse().asDiagonal() * covariance.block(at, at, count, count) * usual.cwiseInverse().asDiagonal();
    const Eigen::MatrixXd seen = inverse(scaled) - Eigen::MatrixXd::Identity(count, count);
    // The same beside the geometry alone.
    const Eigen::MatrixXd cross = normal.block(0, at, geometry_, count);
    Eigen::MatrixXd alone = normal.block(at, at, count, count) - cross.transpose() * of_geometry * cross;
    alone = (usual.asDiagonal() * alone * usual.asDiagonal()).eval() - Eigen::MatrixXd::Identity(count, count);
    const SymmetricEigen all = symmetricEigen(seen), own = symmetricEigen(alone);
    constexpr double kNothing = 1e-6;
    const double least = all.values[0], least_alone = own.values[0];
    EffectSight one;
    one.effect = std::string(idOf(part.effect));
    one.detail = part.order ? part.detail + ", order " + std::to_string(static_cast<int>(*part.order)) : part.detail;
    constexpr double kSigmas = 3.0;
    one.detectable =
        least > kNothing ? kSigmas * kUsualEffect / std::sqrt(least) : std::numeric_limits<double>::infinity();
    one.inflation = least > kNothing ? std::sqrt(least_alone / least) : std::numeric_limits<double>::infinity();
    sight.effects.push_back(std::move(one));
    at += count;
  }
  return sight;
}

}  // namespace stiffscope::planning
