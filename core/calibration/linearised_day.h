#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "core/calibration/fitted_day.h"

namespace stiffscope::calibration {

/// Whitened columns of a part's terms across the geometry, and their lengths before that was projected off.
struct PartColumns {
  Eigen::MatrixXd across;
  Eigen::VectorXd lengths;
};

/// Effects beside the geometry, as far as they are linear about it: what is left and what was spent on it.
struct LinearModel {
  std::vector<EffectPart> parts = {};
  std::vector<std::shared_ptr<const PartColumns>> columns = {};  ///< of each part
  Eigen::MatrixXd directions;  ///< orthonormal, across the geometry: what the parts can do
  Eigen::VectorXd residual;    ///< whitened
  double penalty = 0.0;        ///< of BIC, and of the alternatives that were tried

  double squares() const { return residual.squaredNorm(); }
};

/// How the postures that take part are chosen and divided.
struct LinearisationOptions {
  std::size_t most_postures = 2000;  ///< evenly chosen, neighbours by fours: what comes in pairs is not split
  int inner_folds = 5;
  std::function<int(int pose)> inner_fold;  ///< of each posture, by its place in the campaign
  int outer_folds = 2;                      ///< those that held-out figures are stated for
  std::function<int(int pose)> outer_fold;
};

/// A day's readings as linear equations about a fit of the geometry, whitened by the noise of that fit, with what the
/// geometry can do projected off. Readings of weight 0 in the fit take no part.
class LinearisedDay {
 public:
  /// Keeps references to both.
  LinearisedDay(const UnloadedDay& day, const ArmFit& geometry, LinearisationOptions options);

  const UnloadedDay& day() const { return day_; }
  const std::vector<std::size_t>& postures() const { return postures_; }  ///< places in the day's
  const std::vector<PostureEquations>& equations() const { return equations_; }
  Eigen::Index firstRow(std::size_t k) const { return first_row_[k]; }
  Eigen::Index rows() const { return residual_.size(); }
  const Eigen::MatrixXd& geometry() const { return basis_; }  ///< orthonormal
  double timeBefore(std::size_t k) const;                     ///< between that posture and the one before

  LinearModel geometryAlone() const;

  /// The rms noise of one coordinate by which the rows are whitened, m.
  double noise() const;

  /// Whitened columns of terms, the geometry not yet projected off.
  Eigen::MatrixXd columnsOf(const std::vector<EffectTerm>& terms) const;
  Eigen::MatrixXd acrossGeometry(const Eigen::MatrixXd& columns) const;

  /// Adds a part to a model. Columns that the geometry and the model can do themselves add nothing.
  void add(EffectPart part, PartColumns columns, double penalty, LinearModel& model) const;

  /// The model with those parts alone, in their order, that are to stay.
  LinearModel keeping(const LinearModel& model, const std::function<bool(const EffectPart&)>& stays) const;

  /// By how much reflectors of one posture err together in a residual, one at least: variance of their sum.
  double designEffect(const Eigen::VectorXd& residual) const;

  /// Sum of squared whitened residuals, each inner fold by what the others fit, geometry included.
  double heldOut(const LinearModel& model) const;
  /// Squared residuals of each posture, m^2, each outer fold by what the others fit.
  std::vector<double> heldOutByPosture(const LinearModel& model) const;
  /// Sums of these, first of the outer folds, then of other divisions into as many: pieces of postures in a row that
  /// were of one fold stay whole, and which fold a piece is of is drawn, by the same draws for every model.
  std::vector<double> heldOutByDivision(const LinearModel& model, int others) const;

  static constexpr double kAliased = 1e-3;  ///< of a column's length: what is left of it is nothing of its own

 private:
  void addDirections(const PartColumns& columns, LinearModel& model) const;
  void choosePostures(const ArmFit& geometry);
  void gather(const ArmFit& geometry);
  /// Postures in a row that are of one fold.
  struct Run {
    std::size_t first, end;  ///< places in postures_
    Eigen::Index row, rows;
    int fold;
  };
  std::vector<Run> runsOf(const std::vector<int>& fold) const;
  Eigen::MatrixXd allColumns(const LinearModel& model, Eigen::Index from, Eigen::Index rows) const;
  double plainSquares(std::size_t p, const Eigen::Ref<const Eigen::VectorXd>& residual) const;  ///< m^2
  /// Calls with each posture's whitened residual, its fold predicted by the others: a direction that these do not see
  /// is left alone.
  template <class Use>
  void holdOut(const LinearModel& model, int folds, const std::vector<int>& fold, const Use& use) const;

  const UnloadedDay& day_;
  const ArmFit& fit_;
  LinearisationOptions options_;
  std::vector<std::size_t> first_reading_;  ///< of each posture of the day
  std::vector<std::size_t> postures_;
  std::vector<PostureEquations> equations_;
  std::vector<Eigen::Index> first_row_;
  std::vector<int> inner_fold_, outer_fold_;  ///< of each posture
  Eigen::MatrixXd basis_;
  Eigen::VectorXd residual_;
};

}  // namespace stiffscope::calibration
