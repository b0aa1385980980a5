#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/diagnosis/linear_system.h"

namespace stiffscope::diagnosis {

/// The equations of the effects with everything else (stiffnesses, geometry, weights) fitted away, from
/// normal equations N over (nuisances n, effects e): S = N_ee - N_en N_nn^-1 N_ne, s = b_e - N_en N_nn^-1
/// b_n. chi2 of a set K of effect parameters is chi2_none - s_K' S_KK^-1 s_K.
struct Projection {
  Eigen::MatrixXd matrix;  ///< S
  Eigen::VectorXd right;   ///< s
  Eigen::VectorXd before;  ///< diagonal of N_ee: what the columns are before the projection
  double chi2_none = 0.0;
  Eigen::MatrixXd by_effects;  ///< nuisances = by_nothing - by_effects * effects; empty: not asked for
  Eigen::VectorXd by_nothing;
  JointVector compliance_variance;  ///< of the first nuisances, no effect in the model
};

/// Sum of the postures' normal equations, each times its weight, plus the sweeps'.
Eigen::MatrixXd sumOf(const LinearSystem& data, const std::vector<double>& weights);

/// The same for each of several sets of weights, to within rounding: the equations are gone through once for all of
/// them.
std::vector<Eigen::MatrixXd> sumsOf(const LinearSystem& data, std::span<const std::vector<double>> weights);

/// What the model of stiffnesses alone is, a parameter vector for each of the two gaps.
struct StiffnessesAlone {
  Eigen::VectorXd for_deflection;  ///< compliances fitted to the deflections alone: no position in it
  Eigen::VectorXd for_position;    ///< all nuisances fitted to everything
};

StiffnessesAlone stiffnessesAlone(const LinearSystem& data, const std::vector<double>& weights,
                                  const Projection& projection);

/// Nuisances, then all effects' parameters, as the columns of the equations stand.
Eigen::VectorXd allParameters(const Eigen::VectorXd& nuisances, const Eigen::VectorXd& effects);

Projection project(const Eigen::MatrixXd& normal, const GapLayout& layout);

/// Standard deviation of a joint's compliance by the noise, with these effect parameters in the model.
double complianceSd(const Projection& projection, const std::vector<Eigen::Index>& indices,
                    const Eigen::VectorXd& prior, Eigen::Index joint);

/// A least-squares solution over some effect parameters, others zero.
struct SubsetFit {
  Eigen::VectorXd value;  ///< one an index given
  double drop = 0.0;      ///< of chi2
};

/// Bounded below by zero where `positive` says so (active set). `prior` is 1/most^2 of each: keeps what the
/// data does not see from running away.
SubsetFit fitSubset(const Projection& projection, const std::vector<Eigen::Index>& indices,
                    const std::vector<bool>& positive, const Eigen::VectorXd& prior);

/// The fall of chi2 by fitSubset, to within rounding, of many sets that begin alike: a parameter adds a row to the
/// Cholesky factor of the scaled equations. Keeps references.
class GrowingSubset {
 public:
  GrowingSubset(const Projection& projection, const Eigen::VectorXd& prior);

  void add(Eigen::Index index, bool positive);
  void cutTo(std::size_t size);  ///< the first so many of the parameters
  std::size_t size() const { return unknowns_.size(); }
  double drop() const;
  /// What the fall can be at most: none of them bounded; infinite where rounding hides it.
  double mostDrop() const;

 private:
  struct Unknown {
    Eigen::Index index = 0;
    bool positive = false;
    double scale = 0.0;
    double turned = 0.0;  ///< row of L^-1 b
    double drop = 0.0;    ///< of chi2 with it and those before it, none bounded
    bool sound = true;    ///< its row, and all before it, is more than rounding
  };

  std::ptrdiff_t mostNegative() const;  ///< of those that must be positive; -1: none is negative
  void remove(std::size_t place);
  double dropOfSubset() const;

  const Projection& projection_;
  const Eigen::VectorXd& prior_;
  std::vector<Unknown> unknowns_;
  std::vector<double> lower_;  ///< rows of the factor, one after the other
};

}  // namespace stiffscope::diagnosis
