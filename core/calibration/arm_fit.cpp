#include "core/calibration/arm_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/calibration/fitted_day.h"
#include "core/numerics/resampling.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::calibration {

namespace {

constexpr double kMedianChi2Of3 = 2.365974;  // of a chi-square variable with three degrees of freedom

class Fitting {
 public:
  Fitting(const UnloadedDay& day, const FitOptions& options, ArmFit& fit)
      : day_(day), options_(options), fit_(fit), sums_(day, fit) {
    const std::size_t at = day.readings();
    used_ = options.weights.empty() ? std::vector<double>(at, 1.0) : options.weights;
    distances_.assign(at, 0.0);
    fit_.weights = used_;
    for (std::size_t i = 0; i < day.postures.size(); ++i) {
      bool any = false;
      for (std::size_t k = 0; k < day.postures[i].readings.size(); ++k)
        any = any || used_[sums_.firstReading(i) + k] > 0.0;
      if (any) all_.push_back(i);
    }
    visited_ = all_;
    prior_ = Eigen::VectorXd::Zero(fit_.steps.size() + fit_.sizes.size());
    constexpr double kAnywhere = 1.0;  // m and rad: base and reflectors, found by the start to millimetres
    prior_.head(fit_.steps.size()).setConstant(1.0 / (kAnywhere * kAnywhere));
    for (Eigen::Index k = 0; k < fit_.places().axes(); ++k) {
      const double sd = k % 4 < 2 ? kAxisShiftPrior : kAxisTiltPrior;
      prior_[k] = 1.0 / (sd * sd);
    }
    Eigen::Index k = fit_.steps.size();
    for (const EffectPart& part : fit_.parts) {
      for (const EffectTerm& term : part.terms) prior_[k++] = 1.0 / (term.most * term.most);
    }
    for (const EffectTerm& term : fit_.stations) prior_[k++] = 1.0 / (term.most * term.most);
  }

  /// `known`: the scale is that of an earlier fit, which is where this one starts.
  void run(bool known) {
    if (!known) startScale();
    if (options_.robust) {
      visited_ = evenly(all_);
      iterate(true);
      visited_ = all_;
      reject();
    }
    iterate(false);
    if (options_.robust) {
      // The rejected are judged once more by the model as it is without them.
      reject();
      iterate(false);
    }
    conclude();
  }

 private:
  Eigen::Index count() const { return prior_.size(); }

  /// Some of the postures, neighbours by fours: what is wrong among ten thousand is told by a model of two thousand.
  static std::vector<std::size_t> evenly(const std::vector<std::size_t>& all) {
    constexpr std::size_t kEnough = 2000, kTogether = 4;
    const std::size_t every = all.size() / kEnough + 1;
    std::vector<std::size_t> some;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if ((k / kTogether) % every == 0) some.push_back(all[k]);
    }
    return some;
  }

  /// Calls with each reading of the postures visited that may be used.
  template <class Use>
  void forEachUsed(const Use& use) const {
    for (const std::size_t i : visited_) {
      for (std::size_t k = sums_.firstReading(i); k < sums_.firstReading(i) + day_.postures[i].readings.size(); ++k) {
        if (used_[k] > 0.0) use(k);
      }
    }
  }

  /// Of the postures visited, of weight above zero.
  std::size_t usedReadings() const {
    std::size_t sum = 0;
    forEachUsed([&](std::size_t k) { sum += fit_.weights[k] > 0.0 ? 1 : 0; });
    return sum;
  }

  /// What is free but for the stations' poses, of which each is known beforehand by an equation of its own.
  double machineUnknowns() const { return static_cast<double>(fit_.free.size() - fit_.stations.size()); }

  double dofShare() const {
    const double rows = 3.0 * static_cast<double>(usedReadings());
    return std::max(0.05, (rows - machineUnknowns()) / std::max(1.0, rows));
  }

  void startScale() {
    const std::vector<Eigen::Vector3d> residuals = residualsOf(day_, fit_);
    std::vector<double> squares;
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      if (used_[i] > 0.0) squares.push_back(residuals[i].squaredNorm());
    }
    fit_.model_sd = std::sqrt(numerics::upperMedian(std::move(squares)) / kMedianChi2Of3);
  }

  /// By what is free; before that is known by all that may be.
  FitSum sums() {
    if (!fit_.free.empty()) return sums_.over(fit_, visited_, fit_.free, distances_);
    std::vector<int> all;
    for (int k = options_.axes ? 0 : static_cast<int>(fit_.places().baseAt()); k < static_cast<int>(count()); ++k)
      all.push_back(k);
    return sums_.over(fit_, visited_, all, distances_);
  }

  /// What is a choice of frame, and what the postures do not see: base and reflectors come first, then the axes from
  /// the tip inwards, and a parameter is held whose column lies in the span of those before it. A hundred-thousandth of
  /// the column's length is no information.
  void chooseFree(const Eigen::MatrixXd& normal) {
    fit_.free.clear();
    fit_.held.clear();
    std::vector<int> order;
    for (int k = static_cast<int>(fit_.places().baseAt()); k < static_cast<int>(fit_.steps.size()); ++k)
      order.push_back(k);
    for (int axis = day_.arm.axes() - 1; options_.axes && axis >= 0; --axis) {
      for (int k = 0; k < 4; ++k) order.push_back(4 * axis + k);
    }
    const auto size = static_cast<Eigen::Index>(order.size());
    Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(size, size);
    Eigen::Index rank = 0;
    constexpr double kNothingNew = 1e-10;  // of squares
    for (const int column : order) {
      const double own = normal(column, column);
      // Forward substitution of this column's products with those that are free.
      Eigen::VectorXd row(rank);
      for (Eigen::Index r = 0; r < rank; ++r) {
        const int other = fit_.free[static_cast<std::size_t>(r)];
        const double product = normal(std::max(column, other), std::min(column, other));
        row[r] = (product - lower.row(r).head(r).dot(row.head(r))) / lower(r, r);
      }
      const double rest = own - row.squaredNorm();
      if (own > 0.0 && rest > kNothingNew * own) {
        lower.row(rank).head(rank) = row.transpose();
        lower(rank, rank) = std::sqrt(rest);
        ++rank;
        fit_.free.push_back(column);
      } else if (column < fit_.places().axes()) {
        fit_.held.push_back(column);
      }
    }
    std::sort(fit_.held.begin(), fit_.held.end());
    std::sort(fit_.free.begin(), fit_.free.end());
    for (Eigen::Index k = 0; k < fit_.sizes.size(); ++k) {
      if (!fit_.refused[static_cast<std::size_t>(k)]) fit_.free.push_back(static_cast<int>(fit_.steps.size() + k));
    }
  }

  double valueOf(int k) const {
    const auto at = static_cast<Eigen::Index>(k);
    return at < fit_.steps.size() ? fit_.steps[at] : fit_.sizes[at - fit_.steps.size()];
  }

  /// Normal matrix with the prior, and the right side, of what is free.
  void freeSystem(const Eigen::MatrixXd& normal, Eigen::MatrixXd& matrix, Eigen::VectorXd& right) const {
    const auto size = static_cast<Eigen::Index>(fit_.free.size());
    matrix.resize(size, size);
    right.resize(size);
    for (Eigen::Index r = 0; r < size; ++r) {
      const int i = fit_.free[static_cast<std::size_t>(r)];
      for (Eigen::Index c = 0; c <= r; ++c) {
        const int j = fit_.free[static_cast<std::size_t>(c)];
        matrix(r, c) = matrix(c, r) = normal(std::max(i, j), std::min(i, j));
      }
      matrix(r, r) += prior_[i];
      right[r] = normal(count(), i) - prior_[i] * valueOf(i);
    }
  }

  /// Gauss-Newton until the step is small against its uncertainty and the scale stands.
  void iterate(bool robust) {
    constexpr std::size_t kMost = 30;
    constexpr double kSmallStep = 1e-4;             // mean square, in parts of the uncertainty: a hundredth of it
    std::vector<std::pair<double, double>> passed;  // step length and change of the scale, of each turn
    for (std::size_t turn = 0; turn < kMost; ++turn) {
      FitSum sum = sums();
      if (fit_.free.empty()) chooseFree(sum.normal);
      Eigen::MatrixXd matrix;
      Eigen::VectorXd right, step;
      do {
        freeSystem(sum.normal, matrix, right);
        step = solveSymmetric(matrix, right);
      } while (!robust && refuseNegative(step, sum.normal));
      for (std::size_t k = 0; k < fit_.free.size(); ++k) {
        const Eigen::Index at = fit_.free[k];
        (at < fit_.steps.size() ? fit_.steps[at] : fit_.sizes[at - fit_.steps.size()]) +=
            step[static_cast<Eigen::Index>(k)];
      }
      const double scale = rescale(robust ? medianScale() : sum.weighted_chi2 / (3.0 * sum.weight * dofShare()));
      if (robust) reweight();
      const double length = step.dot(right) / static_cast<double>(std::max<std::size_t>(1, fit_.free.size()));
      fit_.chi2_per_dof = sum.weighted_chi2 / std::max(1e-300, 3.0 * sum.weight * dofShare());
      constexpr double kSameScale = 3e-3;
      if (turn > 0 && length < kSmallStep && std::abs(scale - 1.0) < kSameScale) return;
      passed.emplace_back(length, scale);
      if (!robust && swings(passed) && (kMost - passed.size()) % 2 == 0) return;
    }
  }

  /// Whether the last two turns were those before them over again. Where a tracker sees range better than angles and
  /// the model leaves hardly more than its noise, the step of the scale is too long by as much as it is, and it swings
  /// between two values for good. Any number of pairs of turns more ends in the same place.
  static bool swings(const std::vector<std::pair<double, double>>& passed) {
    constexpr double kSameStep = 1e-6, kSame = 1e-10;
    const std::size_t turns = passed.size();
    if (turns < 4) return false;
    for (const std::size_t last : {turns - 1, turns - 2}) {
      const auto& [length, scale] = passed[last];
      const auto& [length_before, scale_before] = passed[last - 2];
      if (!(std::abs(length - length_before) <= kSameStep * length && std::abs(scale - scale_before) <= kSame))
        return false;
    }
    return true;
  }

  /// Median of the squared distances against that of chi-square with three degrees of freedom.
  double medianScale() const {
    std::vector<double> squares;
    forEachUsed([&](std::size_t k) { squares.push_back(distances_[k]); });
    const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
    std::nth_element(squares.begin(), middle, squares.end());
    return *middle / (kMedianChi2Of3 * dofShare());
  }

  /// Of the tracker, mean of all coordinates.
  double declaredVariance() const {
    double sum = 0.0;
    for (const Posture& posture : day_.postures) {
      for (const Reading& reading : posture.readings) sum += reading.covariance.trace() / 3.0;
    }
    return sum / static_cast<double>(std::max<std::size_t>(1, used_.size()));
  }

  /// The variance beyond the tracker's that brings `chi2_per_dof` to one; the change of the whole standard deviation.
  double rescale(double chi2_per_dof) {
    const double declared = declaredVariance();
    const double before = declared + fit_.model_sd * fit_.model_sd;
    constexpr double kLeast = 1e-8;  // m: a tracker that declares nothing is better than no instrument
    const double least = declared > 0.0 ? 0.0 : kLeast * kLeast;
    const double model = std::max(least, chi2_per_dof * before - declared);
    fit_.model_sd = std::sqrt(model);
    return std::sqrt((declared + model) / before);
  }

  void reweight() {
    forEachUsed([&](std::size_t k) {
      const double inside = 1.0 - distances_[k] / (options_.gross * options_.gross);
      fit_.weights[k] = inside > 0.0 ? inside * inside : 0.0;
    });
  }

  /// Readings beyond the gross limit are rejected. What more than a twentieth of them do is no gross error but an
  /// effect that is not in the model yet (a reflector that slipped at half the day): then the limit is taken further
  /// out.
  void reject() {
    sums_.distancesOf(fit_, visited_, distances_);
    constexpr double kMostGross = 0.05, kFurther = 4.0;
    double limit = options_.gross * std::sqrt(std::max(1.0, medianScale()));
    const auto beyond = [&] {
      std::size_t gross = 0, all = 0;
      forEachUsed([&](std::size_t k) {
        gross += distances_[k] >= limit * limit ? 1 : 0;
        ++all;
      });
      return static_cast<double>(gross) / static_cast<double>(std::max<std::size_t>(1, all));
    };
    constexpr int kMost = 10;  // a limit a million times as far is none
    for (int k = 0; k < kMost && beyond() > kMostGross; ++k) limit *= kFurther;
    forEachUsed([&](std::size_t k) { fit_.weights[k] = distances_[k] < limit * limit ? 1.0 : 0.0; });
  }

  /// Of the compliances that `step` would make negative the most negative one, in parts of its bound, is put to zero
  /// and its share of the residual back into the equations. False where there is none.
  bool refuseNegative(const Eigen::VectorXd& step, Eigen::MatrixXd& normal) {
    Eigen::Index worst = -1, k = 0;
    double least = 0.0;
    for (const EffectPart& part : fit_.parts) {
      for (const EffectTerm& term : part.terms) {
        const auto found = std::find(fit_.free.begin(), fit_.free.end(), static_cast<int>(fit_.steps.size() + k));
        if (term.positive && found != fit_.free.end()) {
          const double size = (fit_.sizes[k] + step[found - fit_.free.begin()]) / term.most;
          if (size < least) {
            least = size;
            worst = k;
          }
        }
        ++k;
      }
    }
    if (worst < 0) return false;
    const Eigen::Index column = fit_.steps.size() + worst;
    for (Eigen::Index i = 0; i < count(); ++i)
      normal(count(), i) += fit_.sizes[worst] * normal(std::max(i, column), std::min(i, column));
    fit_.sizes[worst] = 0.0;
    fit_.refused[static_cast<std::size_t>(worst)] = true;
    std::erase(fit_.free, static_cast<int>(column));
    return true;
  }

  void conclude() {
    const FitSum sum = sums();
    Eigen::MatrixXd matrix;
    Eigen::VectorXd right;
    freeSystem(sum.normal, matrix, right);
    // Reflectors of one posture share what the model misses: the sum of their residuals has a larger variance.
    fit_.design_effect = sum.squares_apart > 0.0 ? std::max(1.0, sum.squares_together / sum.squares_apart) : 1.0;
    const double factor = std::max(1.0, fit_.chi2_per_dof) * (fit_.model_sd > 0.0 ? fit_.design_effect : 1.0);
    fit_.covariance = factor * solveSymmetric(matrix, Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
    fit_.parameters = static_cast<int>(machineUnknowns());
    fit_.done = fit_.steps.allFinite() && fit_.sizes.allFinite();
  }

  const UnloadedDay& day_;
  const FitOptions& options_;
  ArmFit& fit_;
  FitSums sums_;
  std::vector<std::size_t> all_, visited_;  ///< postures with readings that may be used; those that sums go over
  std::vector<double> used_;
  std::vector<double> distances_;  ///< squared, of each reading in parts of its covariance
  Eigen::VectorXd prior_;          ///< inverse variances
};

}  // namespace

ArmFit fitArm(const UnloadedDay& day, const ArmPlace& place, const std::vector<EffectPart>& parts,
              const FitOptions& options, const ArmFit* from) {
  ArmFit fit;
  fit.place = place;
  fit.start = frames::axesAtStart(day.arm.axes_in_base_at_zero);
  fit.parts = parts;
  Eigen::Index terms = 0;
  for (const EffectPart& part : parts) terms += static_cast<Eigen::Index>(part.terms.size());
  fit.stations = stationPoses(day, place.base_from_points);
  terms += static_cast<Eigen::Index>(fit.stations.size());
  fit.sizes = Eigen::VectorXd::Zero(terms);
  fit.refused.assign(static_cast<std::size_t>(terms), false);
  fit.steps = Eigen::VectorXd::Zero(fit.places().count(day.targets.size()));
  const double readings = static_cast<double>(std::max<std::size_t>(1, day.readings()));
  for (const Posture& posture : day.postures) {
    for (const Reading& reading : posture.readings) fit.centre += place.base_from_points * reading.point / readings;
  }
  if (from != nullptr) {
    fit.steps = from->steps;
    if (!options.axes) fit.steps.head(fit.places().axes()).setZero();
    fit.model_sd = from->model_sd;
  }
  Fitting(day, options, fit).run(from != nullptr);
  return fit;
}

}  // namespace stiffscope::calibration
