#include "core/comparison/geometry_change.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <unordered_map>

#include "core/calibration/fitted_day.h"
#include "core/comparison/change_causes.h"
#include "core/comparison/common_readings.h"
#include "core/comparison/error_components.h"
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
    case UnloadedEffect::kinematic_error:
    case UnloadedEffect::joint_compliance:
    case UnloadedEffect::gravity_compensator:
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
    setCovariances();
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
    const auto used = [&](std::size_t k, const Place& place) { return weightOf(k, place) > 0.0; };
    CommonReadings found = commonReadings(day(0), day(1));
    std::erase_if(found.readings,
                  [&](const CommonReading& one) { return !used(0, one.before) || !used(1, one.after); });
    targets_ = std::move(found.targets);
    common_ = std::move(found.readings);
    result_.postures_common = found.postures;
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

  /// A compliance that either day refuses is in neither: two models would differ by more than the days do.
  void fit() {
    std::array<std::vector<EffectPart>, 2> parts{partsOf(0), partsOf(1)};
    constexpr int kTurns = 4;
    for (int turn = 0; turn < kTurns; ++turn) {
      for (std::size_t k = 0; k < 2; ++k) fitDay(k, parts[k]);
      std::vector<EffectPart> refused;
      for (const ArmFit& fit : fits_) {
        std::size_t term = 0;
        for (const EffectPart& part : fit.parts) {
          if (fit.refused[term]) refused.push_back(part);
          term += part.terms.size();
        }
      }
      if (refused.empty()) break;
      for (std::vector<EffectPart>& of : parts) {
        std::erase_if(of, [&](const EffectPart& part) {
          return std::any_of(refused.begin(), refused.end(), [&](const EffectPart& one) { return same(one, part); });
        });
      }
    }
    for (const EffectPart& part : fits_[0].parts) {
      const std::string id(idOf(part.effect));
      if (ofMachine(part) && std::find(result_.effects.begin(), result_.effects.end(), id) == result_.effects.end())
        result_.effects.push_back(id);
    }
  }

  void fitDay(std::size_t k, const std::vector<EffectPart>& parts) {
    const ArmFit& best = days_[k].best().fit;
    std::vector<double> weights = best.weights;
    if (result_.same_postures) {
      std::fill(weights.begin(), weights.end(), 0.0);
      for (const CommonReading& one : common_) weights[(k == 0 ? one.before : one.after).reading] = 1.0;
    }
    fits_[k] =
        calibration::fitArm(day(k), best.place, parts, {.robust = false, .weights = weights}, &days_[k].geometry().fit);
    residuals_[k] = calibration::residualsOf(day(k), fits_[k]);
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (weights[i] > 0.0) sum += residuals_[k][i].squaredNorm(), ++count;
    }
    (k == 0 ? result_.left_before : result_.left_after) = std::sqrt(sum / std::max(1.0, count));
    rows_[k] = 3.0 * count;
  }

  /// Covariance of each fit's unknowns: by what it leaves, or on the same postures by what the difference of both
  /// leaves, where what the model misses cancels; then each has half of it.
  void setCovariances() {
    const std::array<FitEquations, 2> equations{FitEquations(day(0), fits_[0]), FitEquations(day(1), fits_[1])};
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<Eigen::VectorXd> residuals;
      for (const calibration::PostureEquations& of : equations[k].equations) residuals.push_back(of.residual);
      ErrorComponents errors;
      if (result_.same_postures) {
        residuals = differences(k, equations[k]);
        errors = errorComponents(equations[k], residuals);
        errors.coordinate *= 0.5, errors.angle *= 0.5;
        constexpr double kLeast = 1e-6;  // readings to the same digits are no evidence of no noise
        errors.coordinate = std::max(errors.coordinate, std::max(kLeast, noiseShare(k)));
      } else {
        errors = errorComponents(equations[k], residuals);
      }
      covariances_[k] = covarianceBy(equations[k], errors);
    }
  }

  /// Of the covariance that whitens a day's residuals what the tracker declares.
  double noiseShare(std::size_t k) const {
    double declared = 0.0, count = 0.0;
    for (const calibration::Posture& posture : day(k).postures) {
      for (const calibration::Reading& reading : posture.readings)
        declared += reading.covariance.trace() / 3.0, ++count;
    }
    declared /= std::max(1.0, count);
    const double all = declared + fits_[k].model_sd * fits_[k].model_sd;
    return all > 0.0 ? declared / all : 0.0;
  }

  /// What the residuals of the two days differ by in each posture of day k, in parts of that day's covariance.
  std::vector<Eigen::VectorXd> differences(std::size_t k, const FitEquations& equations) const {
    // Readings of a posture stand in `common_` in the order of the day before; in the equations in that of day k.
    std::unordered_map<std::size_t, std::vector<CommonReading>> by_posture;
    for (const CommonReading& one : common_) by_posture[(k == 0 ? one.before : one.after).posture].push_back(one);
    std::vector<Eigen::VectorXd> all;
    for (std::size_t p = 0; p < equations.postures.size(); ++p) {
      std::vector<CommonReading>& readings = by_posture[equations.postures[p]];
      std::sort(readings.begin(), readings.end(), [k](const CommonReading& a, const CommonReading& b) {
        return k == 0 ? a.before.reading < b.before.reading : a.after.reading < b.after.reading;
      });
      Eigen::VectorXd apart(equations.equations[p].residual.size());
      for (std::size_t r = 0; r < readings.size(); ++r) {
        apart.segment<3>(3 * static_cast<Eigen::Index>(r)) =
            equations.equations[p].whitening[r] *
            (residuals_[1][readings[r].after.reading] - residuals_[0][readings[r].before.reading]);
      }
      all.push_back(std::move(apart));
    }
    return all;
  }

  /// As far as the fit's covariance has it.
  double designEffectOf(std::size_t k) const { return fits_[k].model_sd > 0.0 ? fits_[k].design_effect : 1.0; }

  /// Sizes of the machine's effects that both fits have, and which of each fit's unknowns they are.
  void takeSizes() {
    std::array<std::vector<Eigen::Index>, 2> places;  // in sizes
    for (std::size_t k = 0; k < 2; ++k) {
      Eigen::Index term = 0;
      for (const EffectPart& part : fits_[k].parts) {
        for (std::size_t t = 0; t < part.terms.size(); ++t, ++term) {
          if (ofMachine(part)) places[k].push_back(term);
        }
      }
    }
    std::vector<std::array<Eigen::Index, 2>> both;  // in `free`
    for (std::size_t i = 0; i < places[0].size(); ++i) {
      std::array<Eigen::Index, 2> at{};
      bool free = true;
      for (std::size_t k = 0; k < 2; ++k) {
        const std::vector<int>& unknowns = fits_[k].free;
        const auto found =
            std::find(unknowns.begin(), unknowns.end(), static_cast<int>(fits_[k].steps.size() + places[k][i]));
        free = free && found != unknowns.end();
        at[k] = found - unknowns.begin();
      }
      if (free) both.push_back(at);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      const auto count = static_cast<Eigen::Index>(both.size());
      by_effects_[k] = Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(fits_[k].free.size()));
      sizes_[k].resize(count);
      for (Eigen::Index i = 0; i < count; ++i) {
        const Eigen::Index at = both[static_cast<std::size_t>(i)][k];
        by_effects_[k](i, at) = 1.0;
        sizes_[k][i] = fits_[k].sizes[fits_[k].free[static_cast<std::size_t>(at)] - fits_[k].steps.size()];
      }
    }
  }

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
      const Eigen::MatrixXd own = by * covariances_[k] * by.transpose();
      covariance_ = k == 0 ? own : Eigen::MatrixXd(covariance_ + own);
      by_free_[k] = std::move(by);
    }
    takeSizes();
    difference_ = all[1] - all[0];
    difference_.head(numbers_->count()) =
        numbers_->difference(all[0].head(numbers_->count()), all[1].head(numbers_->count()));
    setDof();
    holdEffects();
    result_.base.turn = difference_.segment<3>(difference_.size() - 6), result_.base.shift = difference_.tail<3>();
  }

  /// Readings of one posture that err together count as one.
  void setDof() {
    const auto dofOf = [&](std::size_t k) { return (rows_[k] - fits_[k].parameters) / designEffectOf(k); };
    dof_ = std::max(1.0, result_.same_postures ? std::min(dofOf(0), dofOf(1)) : dofOf(0) + dofOf(1));
  }

  /// Effects of the machine are one in both days, as far as their sizes do not say otherwise: with e = s_after -
  /// s_before held at zero the geometry's difference is d - C_de C_ee^-1 e, its covariance C_dd - C_de C_ee^-1 C_ed. An
  /// effect that looks like a joint's zero in a day's postures then takes nothing from the zero's difference.
  void holdEffects() {
    const Eigen::Index sizes = by_effects_[0].rows();
    if (sizes == 0) return;
    Eigen::VectorXd change = sizes_[1] - sizes_[0];
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(sizes, sizes),
                    across = Eigen::MatrixXd::Zero(difference_.size(), sizes);
    for (std::size_t k = 0; k < 2; ++k) {
      own += by_effects_[k] * covariances_[k] * by_effects_[k].transpose();
      across += by_free_[k] * covariances_[k] * by_effects_[k].transpose();
    }
    const int count = static_cast<int>(sizes);
    result_.effects_p = metrology::fTail(mahalanobisSquared(change, own) / count, count, dof_);
    result_.effects_changed = result_.effects_p < kChangeLevel;
    if (result_.effects_changed) return;
    difference_ -= across * solveSymmetric(own, change);
    covariance_ -= across * solveSymmetric(own, across.transpose());
  }

  /// Whether some unknown of both fits moves the number.
  bool movesWith(Eigen::Index number) const {
    return !by_free_[0].row(number).isZero() && !by_free_[1].row(number).isZero();
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
      one.identified = one.difference.sd > 0.0 && one.difference.sd < kOfPrior * prior && movesWith(k);
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
    if (result_.effects_changed) result_.cautions.emplace_back(RemarkId::effects_changed, result_.effects_p);
    if (targets_[0].empty()) result_.cautions.emplace_back(RemarkId::no_common_reflector);
    result_.cautions.emplace_back(RemarkId::zero_1_with_base);
    result_.cautions.emplace_back(RemarkId::zero_6_with_reflectors);
  }

  const campaign::Campaign &before_, &after_;
  std::array<calibration::Calibration, 2> days_;
  std::array<std::vector<int>, 2> targets_;  ///< of both days, in each one's numbers
  std::vector<CommonReading> common_;
  std::array<ArmFit, 2> fits_;
  std::array<Eigen::MatrixXd, 2> covariances_;  ///< of their unknowns
  std::array<std::vector<Eigen::Vector3d>, 2> residuals_;
  std::array<double, 2> rows_{};
  std::unique_ptr<GeometryNumbers> numbers_;
  Eigen::VectorXd difference_, reflectors_shift_;
  Eigen::MatrixXd covariance_, reflectors_covariance_, moves_;
  std::array<Eigen::MatrixXd, 2> by_free_, by_effects_;  ///< of all numbers, of effects' sizes, by a fit's unknowns
  std::array<Eigen::VectorXd, 2> sizes_;
  std::vector<Eigen::Index> seen_;  ///< numbers that both days identify
  double dof_ = 1.0;
  GeometryChange result_;
};

}  // namespace

GeometryChange compareGeometry(const campaign::Campaign& before, const campaign::Campaign& after) {
  return Comparing(before, after).run();
}

}  // namespace stiffscope::comparison
