#include "core/calibration/effect_selection.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/calibration/fitted_day.h"
#include "core/calibration/periodogram.h"
#include "metrology/linear_algebra.h"

namespace stiffscope::calibration {

namespace {

/// A part that was tried, and by how much it lowers the sum of the squared whitened residuals.
struct Candidate {
  EffectPart part{};
  double gain = 0.0;
  int tried = 1;  ///< alternatives of its kind
};

/// Log of the probability that a chi-square variable of `dof` degrees of freedom exceeds x, from its leading term.
double logTail(double x, int dof) {
  const double half = dof / 2.0;
  return std::min(0.0, -x / 2.0 + (half - 1.0) * std::log(std::max(1e-300, x / 2.0)) - std::lgamma(half));
}

class Selection {
 public:
  Selection(const UnloadedDay& day, const ArmFit& fit, const SelectionOptions& options)
      : day_(day), fit_(fit), options_(options) {
    choosePostures();
    gather();
  }

  std::vector<EffectPart> run() {
    std::vector<EffectPart> found;
    const std::vector<EffectPart> fixed = fixedParts(day_);
    setFixedColumns(fixed);
    Periodogram periodogram(equations_, postures_, day_, basis_, residual_);
    std::vector<bool> gone(fixed.size(), false);
    for (int round = 0; round < options_.most_parts; ++round) {
      std::vector<Candidate> candidates;
      addFixed(fixed, gone, candidates);
      for (const PeriodicPeak& peak : periodogram.peaks()) {
        candidates.push_back({transmissionError(peak.joint, peak.order), peak.gain, Periodogram::kTried});
      }
      addJumps(candidates);
      std::sort(candidates.begin(), candidates.end(),
                [&](const Candidate& a, const Candidate& b) { return worth(a) > worth(b); });
      candidates.resize(std::min(candidates.size(), kTries));
      const auto taken =
          std::find_if(candidates.begin(), candidates.end(), [&](Candidate& candidate) { return holds(candidate); });
      if (taken == candidates.end()) break;
      const Eigen::MatrixXd directions = take(columnsOfPart(taken->part));
      periodogram.projectOff(directions, coefficients_);
      for (std::size_t k = 0; k < fixed.size(); ++k) {
        if (fixed[k].effect == taken->part.effect && fixed[k].detail == taken->part.detail &&
            fixed[k].terms.front().name == taken->part.terms.front().name)
          gone[k] = true;
        fixed_columns_[k] -= directions * (directions.transpose() * fixed_columns_[k]);
      }
      found.push_back(std::move(taken->part));
    }
    return found;
  }

 private:
  static constexpr std::size_t kTries = 4;  ///< best ones looked at before nothing is left to find

  /// Of those that have readings of weight; neighbours stay together by fours: what comes in pairs is not split.
  void choosePostures() {
    std::vector<std::size_t> usable;
    std::size_t reading = 0;
    for (std::size_t i = 0; i < day_.postures.size(); ++i) {
      first_reading_.push_back(reading);
      bool any = false;
      for (std::size_t k = 0; k < day_.postures[i].readings.size(); ++k, ++reading)
        any = any || fit_.weights[reading] > 0.0;
      if (any) usable.push_back(i);
    }
    constexpr std::size_t kTogether = 4;
    const std::size_t every =
        (usable.size() + options_.most_postures - 1) / std::max<std::size_t>(1, options_.most_postures);
    for (std::size_t k = 0; k < usable.size(); ++k) {
      if ((k / kTogether) % std::max<std::size_t>(1, every) == 0) postures_.push_back(usable[k]);
    }
  }

  void gather() {
    Eigen::Index rows = 0;
    for (const std::size_t i : postures_) {
      equations_.push_back(equationsOf(day_, fit_, i, first_reading_[i]));
      first_row_.push_back(rows);
      rows += equations_.back().residual.size();
    }
    const auto parameters = static_cast<Eigen::Index>(fit_.free.size());
    Eigen::MatrixXd jacobian(rows, parameters);
    residual_.resize(rows);
    for (std::size_t k = 0; k < postures_.size(); ++k) {
      jacobian.middleRows(first_row_[k], equations_[k].residual.size()) = equations_[k].by_parameters;
      residual_.segment(first_row_[k], equations_[k].residual.size()) = equations_[k].residual;
    }
    // Orthonormal basis of what geometry can do: modified Gram-Schmidt by way of the normal matrix, twice.
    const Eigen::VectorXd length = jacobian.colwise().norm();
    for (Eigen::Index k = 0; k < parameters; ++k) jacobian.col(k) /= std::max(1e-300, length[k]);
    const SymmetricEigen eigen = symmetricEigen(jacobian.transpose() * jacobian);
    constexpr double kNothing = 1e-9;
    Eigen::Index rank = 0;
    for (Eigen::Index k = 0; k < parameters; ++k) rank += eigen.values[k] > kNothing ? 1 : 0;
    basis_ = jacobian * eigen.vectors.rightCols(rank) * eigen.values.tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
    coefficients_ = basis_.transpose() * residual_;
    residual_ -= basis_ * coefficients_;
    setDesignEffect();
    setFolds();
    setNormals();
  }

  /// Reflectors of one posture err together: what looks like three readings is worth fewer.
  void setDesignEffect() {
    double together = 0.0, apart = 0.0;
    for (std::size_t k = 0; k < postures_.size(); ++k) {
      const Eigen::VectorXd own = residual_.segment(first_row_[k], equations_[k].residual.size());
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (Eigen::Index row = 0; row < own.size(); row += 3) sum += own.segment<3>(row);
      together += sum.squaredNorm();
      apart += own.squaredNorm();
    }
    design_effect_ = apart > 0.0 ? std::max(1.0, together / apart) : 1.0;
  }

  void setFolds() {
    for (const std::size_t i : postures_) fold_.push_back(options_.inner_fold(day_.postures[i].pose));
  }

  Eigen::MatrixXd columnsOfPart(const EffectPart& part) const { return columnsOfTerms(part.terms); }

  Eigen::MatrixXd columnsOfTerms(const std::vector<EffectTerm>& terms) const {
    Eigen::MatrixXd columns(residual_.size(), static_cast<Eigen::Index>(terms.size()));
    for (std::size_t k = 0; k < postures_.size(); ++k) {
      columns.middleRows(first_row_[k], equations_[k].residual.size()) =
          columnsOf(day_, fit_, postures_[k], equations_[k], terms);
    }
    return columns;
  }

  /// All of them in one pass over the postures.
  void setFixedColumns(const std::vector<EffectPart>& fixed) {
    std::vector<EffectTerm> terms;
    for (const EffectPart& part : fixed) terms.insert(terms.end(), part.terms.begin(), part.terms.end());
    const std::size_t of_fixed = terms.size(), targets = day_.targets.size() > 1 ? day_.targets.size() : 0;
    for (std::size_t target = 0; target < targets; ++target) {
      const EffectPart always = targetMotion(day_, static_cast<int>(target), -1.0);
      terms.insert(terms.end(), always.terms.begin(), always.terms.end());
    }
    const Eigen::MatrixXd all = columnsOfTerms(terms);
    const Eigen::MatrixXd across = orthogonal(all.leftCols(static_cast<Eigen::Index>(of_fixed)));
    Eigen::Index at = 0;
    for (const EffectPart& part : fixed) {
      const auto width = static_cast<Eigen::Index>(part.terms.size());
      fixed_columns_.push_back(across.middleCols(at, width));
      at += width;
    }
    for (std::size_t target = 0; target < targets; ++target, at += 3) target_columns_.push_back(all.middleCols(at, 3));
  }

  /// Across the basis; a column of which next to nothing is left is what geometry and the parts found can do.
  Eigen::MatrixXd orthogonal(Eigen::MatrixXd columns) const {
    const Eigen::VectorXd length = columns.colwise().norm();
    for (int pass = 0; pass < 2; ++pass) columns -= basis_ * (basis_.transpose() * columns);
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
      if (columns.col(k).norm() < kAliased * length[k]) columns.col(k).setZero();
    }
    return columns;
  }

  double variance() const {
    return residual_.squaredNorm() / std::max(1.0, static_cast<double>(residual_.size() - basis_.cols()));
  }

  /// Gain beyond what its parameters and the alternatives of its kind would bring by noise alone, in chi-square.
  double worth(const Candidate& candidate) const {
    const double chi2 = candidate.gain / (variance() * design_effect_);
    const double postures = static_cast<double>(postures_.size());
    return chi2 - static_cast<double>(candidate.part.terms.size()) * std::log(postures) -
           2.0 * std::log(static_cast<double>(candidate.tried));
  }

  void addFixed(const std::vector<EffectPart>& fixed, const std::vector<bool>& gone,
                std::vector<Candidate>& candidates) const {
    for (std::size_t k = 0; k < fixed.size(); ++k) {
      if (gone[k]) continue;
      const Eigen::MatrixXd& columns = fixed_columns_[k];
      const Eigen::VectorXd right = columns.transpose() * residual_;
      if (columns.squaredNorm() == 0.0) continue;
      // A compliance explains only with its own sign.
      if (fixed[k].terms.size() == 1 && fixed[k].terms.front().positive && right[0] <= 0.0) continue;
      const Eigen::VectorXd size = solveSymmetric(columns.transpose() * columns, right);
      candidates.push_back({fixed[k], right.dot(size), static_cast<int>(fixed.size())});
    }
  }

  /// What starts at a posture and stays: sums over the postures from there on, for all starts in one pass.
  void addJumps(std::vector<Candidate>& candidates) const {
    const int tried = static_cast<int>(postures_.size());
    if (const auto jump = bestStart([&](std::size_t k) { return equations_[k].by_motion; }, 6))
      candidates.push_back({frameError(jump->first), jump->second, tried});
    // The only reflector's motion would be the flange's: it has no columns.
    for (std::size_t target = 0; target < target_columns_.size(); ++target) {
      const auto columns = [&](std::size_t k) -> Eigen::MatrixXd {
        return target_columns_[target].middleRows(first_row_[k], equations_[k].residual.size());
      };
      if (const auto jump = bestStart(columns, 3))
        candidates.push_back({targetMotion(day_, static_cast<int>(target), jump->first), jump->second, tried});
    }
  }

  /// Time of the best start and its gain.
  template <class Columns>
  std::optional<std::pair<double, double>> bestStart(const Columns& columns_of, Eigen::Index width) const {
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(basis_.cols(), width), own = Eigen::MatrixXd::Zero(width, width);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(width);
    std::optional<std::pair<double, double>> best;
    // Five postures on either side: fewer are outliers.
    constexpr std::size_t kFewest = 5;
    for (std::size_t k = postures_.size(); k-- > kFewest;) {
      const Eigen::MatrixXd columns = columns_of(k);
      const Eigen::Index rows = columns.rows();
      products.noalias() += basis_.middleRows(first_row_[k], rows).transpose() * columns;
      own.noalias() += columns.transpose() * columns;
      right.noalias() += columns.transpose() * residual_.segment(first_row_[k], rows);
      if (k + kFewest > postures_.size()) continue;
      const Eigen::MatrixXd across = own - products.transpose() * products;
      if ((across.diagonal().array() < kAliased * kAliased * own.diagonal().array()).any()) continue;
      const Eigen::VectorXd size = solveSymmetric(across, right);
      const double gain = right.dot(size);
      const double between = (day_.postures[postures_[k]].time + day_.postures[postures_[k - 1]].time) / 2.0;
      if (!best || gain > best->second) best = {between, gain};
    }
    return best;
  }

  /// Whether chance forbids it not, and it predicts postures that were left out.
  bool holds(Candidate& candidate) const {
    const double chi2 = candidate.gain / (variance() * design_effect_);
    const double log_chance =
        logTail(chi2, static_cast<int>(candidate.part.terms.size())) + std::log(static_cast<double>(candidate.tried));
    if (log_chance > std::log(options_.chance)) return false;
    candidate.part.chance = std::exp(log_chance);
    const Eigen::MatrixXd columns = orthogonal(columnsOfPart(candidate.part));
    return heldOut(normalsWith(columns)) < (1.0 - options_.least_gain) * without_;
  }

  /// Normal equations of one inner fold, the residual apart.
  struct FoldNormal {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd right;
    double square = 0.0;
  };

  /// Products of the rows of each fold: of `left` with `right`.
  std::vector<Eigen::MatrixXd> productsByFold(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) const {
    std::vector<Eigen::MatrixXd> products(static_cast<std::size_t>(options_.inner_folds),
                                          Eigen::MatrixXd::Zero(left.cols(), right.cols()));
    for (std::size_t k = 0; k < postures_.size();) {
      // Postures in a row that are of one fold.
      std::size_t end = k + 1;
      while (end < postures_.size() && fold_[end] == fold_[k]) ++end;
      const Eigen::Index from = first_row_[k], rows = first_row_[end - 1] + equations_[end - 1].residual.size() - from;
      products[static_cast<std::size_t>(fold_[k])].noalias() +=
          left.middleRows(from, rows).transpose() * right.middleRows(from, rows);
      k = end;
    }
    return products;
  }

  /// Of the basis with `columns` beside it; those of the basis alone are kept.
  std::vector<FoldNormal> normalsWith(const Eigen::MatrixXd& columns) const {
    const Eigen::Index before = basis_.cols(), width = before + columns.cols();
    const auto across = productsByFold(basis_, columns), own = productsByFold(columns, columns),
               right = productsByFold(columns, residual_);
    std::vector<FoldNormal> normals = normals_;
    for (std::size_t f = 0; f < normals.size(); ++f) {
      FoldNormal& normal = normals[f];
      normal.matrix.conservativeResize(width, width);
      normal.matrix.topRightCorner(before, columns.cols()) = across[f];
      normal.matrix.bottomLeftCorner(columns.cols(), before) = across[f].transpose();
      normal.matrix.bottomRightCorner(columns.cols(), columns.cols()) = own[f];
      normal.right.conservativeResize(width);
      normal.right.tail(columns.cols()) = right[f];
    }
    return normals;
  }

  void setNormals() {
    const auto own = productsByFold(basis_, basis_);
    normals_.resize(own.size());
    for (std::size_t f = 0; f < own.size(); ++f) normals_[f].matrix = own[f];
    setRightSides();
  }

  void setRightSides() {
    const auto right = productsByFold(basis_, residual_), square = productsByFold(residual_, residual_);
    for (std::size_t f = 0; f < normals_.size(); ++f) {
      normals_[f].right = right[f];
      normals_[f].square = square[f](0, 0);
    }
    without_ = heldOut(normals_);
  }

  /// Sum of squared residuals, each inner fold by what the others fit.
  static double heldOut(const std::vector<FoldNormal>& normals) {
    Eigen::MatrixXd matrix = normals.front().matrix;
    Eigen::VectorXd right = normals.front().right;
    for (std::size_t f = 1; f < normals.size(); ++f) {
      matrix += normals[f].matrix;
      right += normals[f].right;
    }
    constexpr double kDamping = 1e-9;  // of what the whole day sees: a fold that cannot see a direction leaves it
    const Eigen::VectorXd damping = kDamping * matrix.diagonal();
    double sum = 0.0;
    for (const FoldNormal& normal : normals) {
      Eigen::MatrixXd others = matrix - normal.matrix;
      others.diagonal() += damping;
      const Eigen::VectorXd sizes = solveSymmetric(others, Eigen::VectorXd(right - normal.right));
      sum += normal.square - 2.0 * sizes.dot(normal.right) + sizes.dot(Eigen::VectorXd(normal.matrix * sizes));
    }
    return sum;
  }

  /// Adds a part's columns to the basis, and takes what they explain off the residual; the new directions.
  Eigen::MatrixXd take(const Eigen::MatrixXd& raw) {
    Eigen::MatrixXd columns = orthogonal(raw), directions(residual_.size(), 0);
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
      Eigen::VectorXd direction = columns.col(k);
      direction -= directions * (directions.transpose() * direction);
      const double length = direction.norm();
      if (length < kAliased * raw.col(k).norm()) continue;
      directions.conservativeResize(Eigen::NoChange, directions.cols() + 1);
      directions.rightCols<1>() = direction / length;
    }
    normals_ = normalsWith(directions);
    coefficients_ = directions.transpose() * residual_;
    residual_ -= directions * coefficients_;
    const Eigen::Index before = basis_.cols();
    basis_.conservativeResize(Eigen::NoChange, before + directions.cols());
    basis_.rightCols(directions.cols()) = directions;
    setRightSides();
    return directions;
  }

  static constexpr double kAliased = 1e-3;  ///< of a column's length

  const UnloadedDay& day_;
  const ArmFit& fit_;
  const SelectionOptions& options_;
  std::vector<std::size_t> first_reading_;  ///< of each posture of the day
  std::vector<std::size_t> postures_;
  std::vector<PostureEquations> equations_;
  std::vector<Eigen::Index> first_row_;
  std::vector<int> fold_;
  Eigen::MatrixXd basis_;  ///< orthonormal: geometry, then the parts found
  Eigen::VectorXd residual_, coefficients_;
  std::vector<Eigen::MatrixXd> fixed_columns_, target_columns_;
  std::vector<FoldNormal> normals_;  ///< of the basis
  double without_ = 0.0;             ///< held-out sum of squares of the basis alone
  double design_effect_ = 1.0;
};

}  // namespace

std::vector<EffectPart> selectEffects(const UnloadedDay& day, const ArmFit& geometry, const SelectionOptions& options) {
  constexpr std::size_t kFewest = 20;  // postures
  if (day.postures.size() < kFewest) return {};
  return Selection(day, geometry, options).run();
}

}  // namespace stiffscope::calibration
