#include "core/comparison/geometry_change.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <unordered_map>

#include "core/calibration/fitted_day.h"
#include "core/comparison/change_causes.h"
#include "core/comparison/matched_postures.h"
#include "metrology/linear_algebra.h"
#include "metrology/tail_probability.h"

namespace stiffscope::comparison {

using calibration::ArmFit;
using calibration::EffectPart;
using calibration::UnloadedDay;
using calibration::UnloadedEffect;

namespace {

/// Effects of the machine; the others are of one day's time.
bool ofMachine(const EffectPart& part) {
  switch (part.effect) {
    case UnloadedEffect::joint_compliance:
    case UnloadedEffect::link_compliance:
    case UnloadedEffect::bearing_tilt:
    case UnloadedEffect::base_compliance:
    case UnloadedEffect::transmission_error:
    case UnloadedEffect::ratio_error:
    case UnloadedEffect::backlash:
    case UnloadedEffect::read_back_error:
      return true;
    case UnloadedEffect::tracker_drift:
    case UnloadedEffect::frame_error:
    case UnloadedEffect::target_motion:
    case UnloadedEffect::thermal_growth:
    case UnloadedEffect::scale_error:
      break;
  }
  return false;
}

bool same(const EffectPart& a, const EffectPart& b) {
  return a.effect == b.effect && a.detail == b.detail && a.order == b.order &&
         a.terms.front().name == b.terms.front().name;
}

/// One reading of a day: its place in the day's order of readings.
struct Place {
  std::size_t posture = 0, reading = 0;
};

struct CommonReading {
  Place before, after;
};

std::vector<std::size_t> firstReadings(const UnloadedDay& day) {
  std::vector<std::size_t> first;
  std::size_t at = 0;
  for (const calibration::Posture& posture : day.postures) {
    first.push_back(at);
    at += posture.readings.size();
  }
  return first;
}

double twoSidedP(double t, double dof) { return metrology::fTail(t * t, 1, dof); }

class Comparing {
 public:
  Comparing(const campaign::Campaign& before, const campaign::Campaign& after) : before_(before), after_(after) {}

  GeometryChange run() {
    result_.reason = differenceOfMachines(before_.robot, after_.robot);
    if (!result_.reason.empty()) return std::move(result_);
    result_.cautions = doubtsOfOneMachine(before_.robot, after_.robot);
    for (std::size_t k = 0; k < 2; ++k) {
      days_[k] = calibration::calibrate(k == 0 ? before_ : after_, {});
      if (days_[k].reason.empty()) continue;
      result_.reason = Remark(RemarkId::of_one_campaign, k == 0 ? When::before : When::after, days_[k].reason);
      return std::move(result_);
    }
    result_.postures_before = days_[0].day.postures.size(), result_.postures_after = days_[1].day.postures.size();
    matchReadings();
    fit();
    differ();
    testNumbers();
    testReflectors();
    findCauses();
    addCautions();
    return std::move(result_);
  }

 private:
  const UnloadedDay& day(std::size_t k) const { return days_[k].day; }

  void matchReadings() {
    std::unordered_map<std::string, std::size_t> postures, targets;
    for (std::size_t i = 0; i < day(1).postures.size(); ++i)
      postures[day(1).pose_ids[static_cast<std::size_t>(day(1).postures[i].pose)]] = i;
    for (std::size_t t = 0; t < day(1).targets.size(); ++t) targets[day(1).targets[t]] = t;
    for (std::size_t t = 0; t < day(0).targets.size(); ++t) {
      const auto other = targets.find(day(0).targets[t]);
      if (other == targets.end()) continue;
      targets_[0].push_back(static_cast<int>(t)), targets_[1].push_back(static_cast<int>(other->second));
    }
    for (std::size_t k = 0; k < 2; ++k) first_readings_[k] = firstReadings(day(k));
    const auto& first = first_readings_;
    for (std::size_t i = 0; i < day(0).postures.size(); ++i) {
      const calibration::Posture& own = day(0).postures[i];
      const auto found = postures.find(day(0).pose_ids[static_cast<std::size_t>(own.pose)]);
      if (found == postures.end()) continue;
      const calibration::Posture& other = day(1).postures[found->second];
      if ((own.q - other.q).cwiseAbs().maxCoeff() > MatchLimits().angle) continue;
      ++result_.postures_common;
      for (std::size_t r = 0; r < own.readings.size(); ++r) {
        for (std::size_t s = 0; s < other.readings.size(); ++s) {
          if (day(0).targets[static_cast<std::size_t>(own.readings[r].target)] !=
              day(1).targets[static_cast<std::size_t>(other.readings[s].target)])
            continue;
          const CommonReading one{{i, first[0][i] + r}, {found->second, first[1][found->second] + s}};
          if (weightOf(0, one.before) > 0.0 && weightOf(1, one.after) > 0.0) common_.push_back(one);
        }
      }
    }
    const std::size_t fewer = std::min(result_.postures_before, result_.postures_after);
    const double readings = 3.0 * static_cast<double>(common_.size());
    constexpr double kEnough = 2.0;  // coordinates a parameter
    result_.same_postures =
        2 * result_.postures_common >= fewer && readings >= kEnough * days_[0].geometry().fit.parameters;
  }

  double weightOf(std::size_t k, const Place& place) const { return days_[k].best().fit.weights[place.reading]; }

  /// Effects of the day's time alone, and of a machine's where nothing cancels them.
  std::vector<EffectPart> partsOf(std::size_t k) const {
    std::vector<EffectPart> parts;
    for (const EffectPart& part : days_[k].best().fit.parts) {
      if (!ofMachine(part)) parts.push_back(part);
    }
    if (result_.same_postures) return parts;
    for (std::size_t other = 0; other < 2; ++other) {
      for (const EffectPart& part : days_[other].best().fit.parts) {
        if (ofMachine(part) &&
            std::none_of(parts.begin(), parts.end(), [&](const EffectPart& known) { return same(known, part); }))
          parts.push_back(part);
      }
    }
    return parts;
  }

  void fit() {
    for (std::size_t k = 0; k < 2; ++k) {
      const ArmFit& best = days_[k].best().fit;
      std::vector<double> weights = best.weights;
      if (result_.same_postures) {
        std::fill(weights.begin(), weights.end(), 0.0);
        for (const CommonReading& one : common_) weights[(k == 0 ? one.before : one.after).reading] = 1.0;
      }
      fits_[k] = calibration::fitArm(day(k), best.place, partsOf(k), {.robust = false, .weights = weights},
                                     &days_[k].geometry().fit);
      residuals_[k] = calibration::residualsOf(day(k), fits_[k]);
      double sum = 0.0, count = 0.0;
      for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] > 0.0) sum += residuals_[k][i].squaredNorm(), ++count;
      }
      (k == 0 ? result_.left_before : result_.left_after) = std::sqrt(sum / std::max(1.0, count));
      rows_[k] = 3.0 * count;
    }
    for (const EffectPart& part : fits_[0].parts) {
      const std::string id(idOf(part.effect));
      if (ofMachine(part) && std::find(result_.effects.begin(), result_.effects.end(), id) == result_.effects.end())
        result_.effects.push_back(id);
    }
  }

  /// By the declared tracker, m^2.
  const Eigen::Matrix3d& covarianceOf(std::size_t k, const Place& place) const {
    const std::vector<calibration::Reading>& readings = day(k).postures[place.posture].readings;
    return readings[place.reading - first_readings_[k][place.posture]].covariance;
  }

  /// By how much the covariance of a difference on the same postures is less than the sum of both: what the model
  /// misses in both is no error of it. Variance of residuals' differences, reflectors of a posture together.
  double pairedFactor() const {
    double apart = 0.0, of_difference = 0.0, together = 0.0, declared = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < common_.size(); ++i) {
      const Eigen::Vector3d &before = residuals_[0][common_[i].before.reading],
                            &after = residuals_[1][common_[i].after.reading];
      apart += before.squaredNorm() + after.squaredNorm();
      of_difference += (after - before).squaredNorm();
      declared += covarianceOf(0, common_[i].before).trace() + covarianceOf(1, common_[i].after).trace();
      sum += after - before;
      if (i + 1 < common_.size() && common_[i + 1].before.posture == common_[i].before.posture) continue;
      together += sum.squaredNorm();
      sum.setZero();
    }
    const double design_effect = of_difference > 0.0 ? std::max(1.0, together / of_difference) : 1.0;
    const double assumed = 0.5 * (designEffectOf(0) + designEffectOf(1));
    if (!(apart > 0.0)) return 1.0;
    // The tracker's noise at least: readings that agree better are no evidence of a better one.
    const double noise = std::max(1e-6 * apart, declared);
    return std::max(noise, of_difference * design_effect) / (apart * assumed);
  }

  /// As far as the fit's covariance has it.
  double designEffectOf(std::size_t k) const { return fits_[k].model_sd > 0.0 ? fits_[k].design_effect : 1.0; }

  /// Difference of everything, its covariance, and degrees of freedom of that.
  void differ() {
    numbers_ = std::make_unique<GeometryNumbers>(before_.robot);
    const Eigen::Isometry3d points_from_base = numbers_->pointsFromBase(day(0).arm, fits_[0]);
    std::array<Eigen::VectorXd, 2> all;
    covariance_.setZero(0, 0);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto of = [&](const ArmFit& fit) {
        return numbers_->allOf(day(k).arm, fit, targets_[k], points_from_base);
      };
      all[k] = of(fits_[k]);
      const std::size_t free = fits_[k].free.size();
      Eigen::MatrixXd by = Eigen::MatrixXd::Zero(all[k].size(), static_cast<Eigen::Index>(free));
      for (std::size_t f = 0; f < free; ++f) {
        const Eigen::Index at = fits_[k].free[f];
        if (at >= fits_[k].steps.size()) continue;  // an effect's size
        constexpr double kStep = frames::ArmParameters::kSmall;
        ArmFit lower = fits_[k], upper = fits_[k];
        lower.steps[at] -= kStep, upper.steps[at] += kStep;
        Eigen::VectorXd change = of(upper) - of(lower);
        change.head(numbers_->count()) =
            numbers_->difference(of(lower).head(numbers_->count()), of(upper).head(numbers_->count()));
        by.col(static_cast<Eigen::Index>(f)) = change / (2.0 * kStep);
      }
      const Eigen::MatrixXd own = by * fits_[k].covariance * by.transpose();
      sd_of_day_[k] = own.diagonal().cwiseMax(0.0).cwiseSqrt();
      covariance_ = k == 0 ? own : Eigen::MatrixXd(covariance_ + own);
    }
    if (result_.same_postures) covariance_ *= pairedFactor();
    difference_ = all[1] - all[0];
    difference_.head(numbers_->count()) =
        numbers_->difference(all[0].head(numbers_->count()), all[1].head(numbers_->count()));
    result_.base.turn = difference_.segment<3>(difference_.size() - 6), result_.base.shift = difference_.tail<3>();
    // Readings of one posture that err together count as one.
    const auto dofOf = [&](std::size_t k) { return (rows_[k] - fits_[k].parameters) / designEffectOf(k); };
    dof_ = std::max(1.0, result_.same_postures ? std::min(dofOf(0), dofOf(1)) : dofOf(0) + dofOf(1));
  }

  void testNumbers() {
    const Eigen::Index count = numbers_->count();
    const Eigen::MatrixXd moves =
        numbers_->movesOfReflectors(fits_[0].arm(day(0).arm), fits_[0].targetsAtZero(), {&day(0), &day(1)});
    std::vector<double> p_values;
    for (Eigen::Index k = 0; k < count; ++k) {
      NumberChange one;
      one.number = numbers_->machine()[static_cast<std::size_t>(k)];
      one.difference = {difference_[k], std::sqrt(std::max(0.0, covariance_(k, k))), dof_};
      one.at_targets = std::abs(difference_[k]) * std::sqrt(std::max(0.0, moves(k, k)));
      const double prior = one.number.isLength() ? calibration::kAxisShiftPrior : calibration::kAxisTiltPrior;
      constexpr double kOfPrior = 0.5;
      one.identified = one.difference.sd > 0.0 && sd_of_day_[0][k] < kOfPrior * prior &&
                       sd_of_day_[1][k] < kOfPrior * prior && sd_of_day_[0][k] > 0.0 && sd_of_day_[1][k] > 0.0;
      one.p_value = one.identified ? twoSidedP(one.difference.value / one.difference.sd, dof_)
                                   : std::numeric_limits<double>::quiet_NaN();
      if (one.identified) seen_.push_back(k);
      p_values.push_back(one.p_value);
      result_.numbers.push_back(one);
    }
    const std::vector<double> corrected = holm(p_values);
    for (std::size_t k = 0; k < corrected.size(); ++k) result_.numbers[k].p_holm = corrected[k];
    const Eigen::VectorXd change = difference_(seen_);
    const Eigen::MatrixXd covariance = covariance_(seen_, seen_);
    moves_ = moves(seen_, seen_);
    result_.unknowns = static_cast<int>(seen_.size());
    if (seen_.empty()) return;
    result_.chi2 = mahalanobisSquared(change, covariance);
    result_.machine_p = metrology::fTail(result_.chi2 / result_.unknowns, result_.unknowns, dof_);
    result_.machine_changed = result_.machine_p < 0.5 * kChangeLevel;
    result_.at_targets = std::sqrt(std::max(0.0, change.dot(moves_ * change)));
    result_.at_targets_sd = std::sqrt(std::max(0.0, (moves_ * covariance).trace()));
  }

  /// Reflectors as they moved by themselves; of a machine that did not change, with its numbers held.
  void testReflectors() {
    const Eigen::Index count = numbers_->count(), all = 3 * static_cast<Eigen::Index>(targets_[0].size());
    Eigen::VectorXd shift = difference_.segment(count, all);
    reflectors_covariance_ = covariance_.block(count, count, all, all);
    if (!result_.machine_changed && !seen_.empty()) {
      const Eigen::MatrixXd across = covariance_.middleRows(count, all)(Eigen::all, seen_);
      const Eigen::MatrixXd own = covariance_(seen_, seen_);
      shift -= across * solveSymmetric(own, Eigen::VectorXd(difference_(seen_)));
      reflectors_covariance_ -= across * solveSymmetric(own, across.transpose());
    }
    reflectors_shift_ = shift;
    std::vector<double> p_values;
    for (std::size_t t = 0; t < targets_[0].size(); ++t) {
      const auto at = 3 * static_cast<Eigen::Index>(t);
      ReflectorChange one;
      one.target = day(0).targets[static_cast<std::size_t>(targets_[0][t])];
      one.shift = shift.segment<3>(at);
      const Eigen::Matrix3d own = reflectors_covariance_.block<3, 3>(at, at);
      one.sd = own.diagonal().cwiseMax(0.0).cwiseSqrt();
      one.p_value = metrology::fTail(mahalanobisSquared(one.shift, own) / 3.0, 3, dof_);
      p_values.push_back(one.p_value);
      result_.reflectors.push_back(std::move(one));
    }
    const std::vector<double> corrected = holm(p_values);
    for (std::size_t t = 0; t < corrected.size(); ++t) result_.reflectors[t].p_holm = corrected[t];
    result_.reflectors_p = 1.0;
    if (all == 0) return;
    result_.reflectors_p = metrology::fTail(
        mahalanobisSquared(shift, reflectors_covariance_) / static_cast<double>(all), static_cast<int>(all), dof_);
    result_.reflectors_moved = result_.reflectors_p < 0.5 * kChangeLevel;
  }

  void findCauses() {
    const double postures = static_cast<double>(std::max(result_.postures_before, result_.postures_after));
    if (result_.machine_changed) {
      const robot::Robot arm = fits_[0].arm(day(0).arm);
      result_.causes = causesOfMachine(*numbers_, arm, seen_,
                                       {difference_(seen_), covariance_(seen_, seen_), dof_, postures}, moves_);
    } else if (result_.reflectors_moved) {
      result_.causes =
          causesOfReflectors(reflectorsOnAxis6(), {reflectors_shift_, reflectors_covariance_, dof_, postures});
    }
  }

  /// How each reflector moves by a turn about axis 6, flange axes.
  Eigen::VectorXd reflectorsOnAxis6() const {
    const robot::Robot& arm = before_.robot;
    const Eigen::Isometry3d flange_from_base = arm.base_from_flange_at_zero.inverse();
    const metrology::Line& axis = arm.axes_in_base_at_zero[5];
    const std::vector<Eigen::Vector3d> at_zero = fits_[0].targetsAtZero();
    Eigen::VectorXd by(reflectors_shift_.size());
    for (std::size_t t = 0; t < targets_[0].size(); ++t) {
      const Eigen::Vector3d from_axis = at_zero[static_cast<std::size_t>(targets_[0][t])] - axis.point;
      by.segment<3>(3 * static_cast<Eigen::Index>(t)) = flange_from_base.linear() * axis.direction.cross(from_axis);
    }
    return by;
  }

  void addCautions() {
    if (!result_.same_postures)
      result_.cautions.emplace_back(RemarkId::geometry_of_other_postures, result_.postures_common);
    if (targets_[0].empty()) result_.cautions.emplace_back(RemarkId::no_common_reflector);
    result_.cautions.emplace_back(RemarkId::zero_1_with_base);
    result_.cautions.emplace_back(RemarkId::zero_6_with_reflectors);
  }

  const campaign::Campaign &before_, &after_;
  std::array<calibration::Calibration, 2> days_;
  std::array<std::vector<int>, 2> targets_;                 ///< of both days, in each one's numbers
  std::array<std::vector<std::size_t>, 2> first_readings_;  ///< of each posture
  std::vector<CommonReading> common_;
  std::array<ArmFit, 2> fits_;
  std::array<std::vector<Eigen::Vector3d>, 2> residuals_;
  std::array<double, 2> rows_{};
  std::unique_ptr<GeometryNumbers> numbers_;
  Eigen::VectorXd difference_, reflectors_shift_;
  Eigen::MatrixXd covariance_, reflectors_covariance_, moves_;
  std::array<Eigen::VectorXd, 2> sd_of_day_;
  std::vector<Eigen::Index> seen_;  ///< numbers that both days identify
  double dof_ = 1.0;
  GeometryChange result_;
};

}  // namespace

GeometryChange compareGeometry(const campaign::Campaign& before, const campaign::Campaign& after) {
  return Comparing(before, after).run();
}

}  // namespace stiffscope::comparison
