#include "core/comparison/geometry_change.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "core/comparison/change_causes.h"
#include "core/comparison/matched_postures.h"
#include "core/comparison/paired_days.h"
#include "metrology/linear_algebra.h"
#include "metrology/tail_probability.h"

namespace stiffscope::comparison {

using calibration::ArmFit;
using calibration::EffectPart;

namespace {

double twoSidedP(double t, double dof) { return metrology::fTail(t * t, 1, dof); }

class Comparing {
 public:
  Comparing(const campaign::Campaign& before, const campaign::Campaign& after) : before_(before), after_(after) {}

  GeometryChange run() {
    result_.reason = differenceOfMachines(before_.robot, after_.robot);
    if (!result_.reason.empty()) return std::move(result_);
    result_.cautions = doubtsOfOneMachine(before_.robot, after_.robot);
    std::array<calibration::Calibration, 2> days;
    for (std::size_t k = 0; k < 2; ++k) {
      days[k] = calibration::calibrate(k == 0 ? before_ : after_, {});
      if (days[k].reason.empty()) continue;
      result_.reason = Remark(RemarkId::of_one_campaign, k == 0 ? When::before : When::after, days[k].reason);
      return std::move(result_);
    }
    pair_.emplace(std::move(days));
    describe();
    differ();
    testNumbers();
    testReflectors();
    findCauses();
    addCautions();
    return std::move(result_);
  }

 private:
  const calibration::UnloadedDay& day(std::size_t k) const { return pair_->day(k); }

  void describe() {
    result_.postures_before = day(0).postures.size(), result_.postures_after = day(1).postures.size();
    result_.postures_common = pair_->postures_common;
    result_.same_postures = pair_->same_postures;
    result_.left_before = pair_->left[0], result_.left_after = pair_->left[1];
    for (const EffectPart& part : pair_->fits[0].parts) {
      const std::string id(idOf(part.effect));
      if (ofMachine(part) && std::find(result_.effects.begin(), result_.effects.end(), id) == result_.effects.end())
        result_.effects.push_back(id);
    }
  }

  /// Sizes of the machine's effects that both fits have, and which of each fit's unknowns they are.
  void takeSizes() {
    std::array<std::vector<Eigen::Index>, 2> places;  // in sizes
    for (std::size_t k = 0; k < 2; ++k) {
      Eigen::Index term = 0;
      for (const EffectPart& part : pair_->fits[k].parts) {
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
        const std::vector<int>& unknowns = pair_->fits[k].free;
        const auto found =
            std::find(unknowns.begin(), unknowns.end(), static_cast<int>(pair_->fits[k].steps.size() + places[k][i]));
        free = free && found != unknowns.end();
        at[k] = found - unknowns.begin();
      }
      if (free) both.push_back(at);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      const auto count = static_cast<Eigen::Index>(both.size());
      by_effects_[k] = Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(pair_->fits[k].free.size()));
      sizes_[k].resize(count);
      for (Eigen::Index i = 0; i < count; ++i) {
        const Eigen::Index at = both[static_cast<std::size_t>(i)][k];
        by_effects_[k](i, at) = 1.0;
        sizes_[k][i] =
            pair_->fits[k].sizes[pair_->fits[k].free[static_cast<std::size_t>(at)] - pair_->fits[k].steps.size()];
      }
    }
  }

  /// Difference of everything, its covariance, and degrees of freedom of that.
  void differ() {
    numbers_ = std::make_unique<GeometryNumbers>(before_.robot);
    const Eigen::Isometry3d points_from_base = numbers_->pointsFromBase(day(0).arm, pair_->fits[0]);
    std::array<Eigen::VectorXd, 2> all;
    covariance_.setZero(0, 0);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto of = [&](const ArmFit& fit) {
        return numbers_->allOf(day(k).arm, fit, pair_->targets[k], points_from_base);
      };
      all[k] = of(pair_->fits[k]);
      const std::size_t free = pair_->fits[k].free.size();
      Eigen::MatrixXd by = Eigen::MatrixXd::Zero(all[k].size(), static_cast<Eigen::Index>(free));
      for (std::size_t f = 0; f < free; ++f) {
        const Eigen::Index at = pair_->fits[k].free[f];
        if (at >= pair_->fits[k].steps.size()) continue;  // an effect's size
        constexpr double kStep = frames::ArmParameters::kSmall;
        ArmFit lower = pair_->fits[k], upper = pair_->fits[k];
        lower.steps[at] -= kStep, upper.steps[at] += kStep;
        Eigen::VectorXd change = of(upper) - of(lower);
        change.head(numbers_->count()) =
            numbers_->difference(of(lower).head(numbers_->count()), of(upper).head(numbers_->count()));
        by.col(static_cast<Eigen::Index>(f)) = change / (2.0 * kStep);
      }
      const Eigen::MatrixXd own = propagated(by, pair_->covariances[k]);
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
    const auto dofOf = [&](std::size_t k) {
      return (pair_->rows[k] - pair_->fits[k].parameters) / pair_->designEffectOf(k);
    };
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
      own += propagated(by_effects_[k], pair_->covariances[k]);
      across += by_free_[k] * pair_->covariances[k] * by_effects_[k].transpose();
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
        numbers_->movesOfReflectors(pair_->fits[0].arm(day(0).arm), pair_->fits[0].targetsAtZero(), {&day(0), &day(1)});
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
    const Eigen::Index count = numbers_->count(), all = 3 * static_cast<Eigen::Index>(pair_->targets[0].size());
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
    for (std::size_t t = 0; t < pair_->targets[0].size(); ++t) {
      const auto at = 3 * static_cast<Eigen::Index>(t);
      ReflectorChange one;
      one.target = day(0).targets[static_cast<std::size_t>(pair_->targets[0][t])];
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
      const robot::Robot arm = pair_->fits[0].arm(day(0).arm);
      result_.causes = causesOfMachine(*numbers_, arm, seen_,
                                       {difference_(seen_), covariance_(seen_, seen_), dof_, postures}, moves_);
    } else if (result_.reflectors_moved) {
      result_.causes = causesOfReflectors(reflectorsOnLastAxis(), before_.robot.axes_in_base_at_zero,
                                          {reflectors_shift_, reflectors_covariance_, dof_, postures});
    }
  }

  /// How each reflector moves by a turn about the last axis, flange axes.
  Eigen::VectorXd reflectorsOnLastAxis() const {
    const robot::Robot& arm = before_.robot;
    const Eigen::Isometry3d flange_from_base = arm.base_from_flange_at_zero.inverse();
    const metrology::Line& axis = arm.axes_in_base_at_zero.back();
    const std::vector<Eigen::Vector3d> at_zero = pair_->fits[0].targetsAtZero();
    Eigen::VectorXd by(reflectors_shift_.size());
    for (std::size_t t = 0; t < pair_->targets[0].size(); ++t) {
      const Eigen::Vector3d from_axis = at_zero[static_cast<std::size_t>(pair_->targets[0][t])] - axis.point;
      by.segment<3>(3 * static_cast<Eigen::Index>(t)) = flange_from_base.linear() * axis.direction.cross(from_axis);
    }
    return by;
  }

  void addCautions() {
    if (!result_.same_postures)
      result_.cautions.emplace_back(RemarkId::geometry_of_other_postures, result_.postures_common);
    if (result_.effects_changed) result_.cautions.emplace_back(RemarkId::effects_changed, result_.effects_p);
    if (pair_->targets[0].empty()) result_.cautions.emplace_back(RemarkId::no_common_reflector);
    result_.cautions.emplace_back(RemarkId::zero_1_with_base);
    result_.cautions.emplace_back(RemarkId::zero_of_last_with_reflectors, before_.robot.joints(), before_.robot.axes());
  }

  const campaign::Campaign &before_, &after_;
  std::optional<PairedDays> pair_;
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
