#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/calibration/fitted_arm.h"

namespace stiffscope::calibration {

/// A row a joint.
using AnglesByTerms =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostJoints, Eigen::Dynamic>;

/// The arm and its readings at some values of all parameters.
class FittedDay {
 public:
  /// Keeps references to both.
  FittedDay(const UnloadedDay& day, const ArmFit& fit);

  const ArmFit& fit() const { return fit_; }
  const frames::PlacedArm& arm() const { return arm_; }
  const std::vector<const EffectTerm*>& terms() const { return terms_; }

  /// What a unit of each term turns the joints by, whatever the fit; zero of terms that move reflectors instead.
  AnglesByTerms anglesByTerms(const Posture& posture) const;
  /// As reported, and what the effects turn the joints besides, rad.
  JointVector anglesOf(const Posture& posture) const { return anglesOf(posture, anglesByTerms(posture)); }
  JointVector anglesOf(const Posture& posture, const Eigen::Ref<const AnglesByTerms>& by_terms) const {
    return posture.q + by_terms * fit_.sizes;
  }
  ReflectorAt reflector(const frames::PlacedPosture& placed, const Reading& reading) const;
  /// Measured less modelled, in base_link, m.
  Eigen::Vector3d residual(const Posture& posture, const Reading& reading, const ReflectorAt& at) const;
  /// L^-1 of the residual's covariance L L^T: the tracker's, and what the model leaves beyond it.
  Eigen::Matrix3d whitening(const Reading& reading) const;

 private:
  const UnloadedDay& day_;
  const ArmFit& fit_;
  frames::PlacedArm arm_;
  std::vector<const EffectTerm*> terms_;
};

/// Whitened derivatives of the modelled readings by some of (steps, sizes). Whatever moves all that a posture shows is
/// a small motion, found once for all of its reflectors.
class ReadingDerivatives {
 public:
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;

  /// Where a place would be that of a coordinate 0..2 of whichever reflector is read.
  static constexpr int ofReadReflector(int coordinate) { return -1 - coordinate; }

  /// `places` of the parameters in (steps, sizes), a column each. Keeps a reference to the day.
  ReadingDerivatives(const FittedDay& fitted, const std::vector<int>& places);

  /// The posture of the readings that follow.
  void enter(const frames::PlacedPosture& placed, const Eigen::Ref<const AnglesByTerms>& by_terms);
  /// Rows of a reading of that posture. Valid until the next call.
  const Rows& of(const Posture& posture, const ReflectorAt& at, const Eigen::Matrix3d& whitening);

 private:
  struct Place {
    Eigen::Index column = 0;
    std::size_t of = 0;  ///< axis parameter, coordinate of all reflectors or of the one read, term
  };

  const FittedDay& fitted_;
  std::vector<Place> axes_, targets_, read_, angles_, offsets_;
  Eigen::Array<double, 6, Eigen::Dynamic, Eigen::RowMajor> motions_;  ///< rotations, then shifts
  Rows rows_;
};

/// Measured less modelled of every reading of a day, in the order of the day, in base_link, m. `weights`, one a
/// reading: zero in postures where all are zero.
std::vector<Eigen::Vector3d> residualsOf(const UnloadedDay& day, const ArmFit& fit);
std::vector<Eigen::Vector3d> residualsOf(const UnloadedDay& day, const ArmFit& fit, const std::vector<double>& weights);

/// Equations of the readings about a fit: whitened residuals and their derivatives by (steps, sizes of `fit`), a block
/// of rows a posture; only readings of weight above 0.
struct PostureEquations {
  Eigen::MatrixXd by_parameters;  ///< 3 rows a reading, by `fit.free`
  Eigen::MatrixXd by_angles;      ///< by the joint angles, a column each
  Eigen::MatrixXd by_motion;      ///< by a turn about the base origin (3) and a shift (3) of all that is seen
  Eigen::VectorXd residual;
  std::vector<int> targets;                ///< of each reading
  std::vector<Eigen::Matrix3d> whitening;  ///< of each reading
  std::vector<Eigen::Vector3d> positions;  ///< of each reading, as modelled
  std::vector<Eigen::Vector3d> stations;   ///< of each reading: from where it was read, in base_link
  std::vector<int> places;                 ///< of each reading: which of the day's stations that is
};
PostureEquations equationsOf(const UnloadedDay& day, const ArmFit& fit, std::size_t posture, std::size_t first_reading);
PostureEquations equationsOf(const FittedDay& fitted, const Posture& posture, std::size_t first_reading);

/// Whitened columns of terms in a posture, a column a term.
Eigen::MatrixXd columnsOf(const FittedDay& fitted, const Posture& posture, const PostureEquations& equations,
                          const std::vector<EffectTerm>& terms);

/// Sums over postures of a fit's whitened equations  residual = J step.
struct FitSum {
  /// Lower triangle of [J r]^T [J r], J by (steps, sizes), its rows and columns zero where nothing was asked for.
  Eigen::MatrixXd normal;
  double weighted_chi2 = 0.0, weight = 0.0;
  double squares_together = 0.0, squares_apart = 0.0;  ///< of the whitened residuals of a posture's reflectors
};

/// Makes them for the turns of one fit: what does not change from turn to turn is found once. Postures are taken on all
/// cores; how they are put together depends on their number alone.
class FitSums {
 public:
  /// Keeps a reference to the day. `fit`: of its parts the terms.
  FitSums(const UnloadedDay& day, const ArmFit& fit);

  std::size_t firstReading(std::size_t posture) const { return first_[posture]; }

  /// Over `postures`, by the parameters `places` in (steps, sizes), with the weights of the fit. `distances`, one a
  /// reading of the day: its squared distance from the model in parts of its covariance, of all readings of `postures`.
  FitSum over(const ArmFit& fit, const std::vector<std::size_t>& postures, const std::vector<int>& places,
              std::vector<double>& distances) const;

  /// The distances alone.
  void distancesOf(const ArmFit& fit, const std::vector<std::size_t>& postures, std::vector<double>& distances) const;

 private:
  struct Block;
  struct Equations;
  void addPosture(const FittedDay& fitted, std::size_t i, ReadingDerivatives& derivatives,
                  std::vector<Equations>& equations, Block& sum, std::vector<double>& distances) const;
  auto anglesByTerms(std::size_t posture) const {
    return by_terms_.middleCols(static_cast<Eigen::Index>(posture) * terms_, terms_);
  }

  const UnloadedDay& day_;
  std::vector<std::size_t> first_;  ///< reading of each posture
  Eigen::Index terms_ = 0;
  AnglesByTerms by_terms_;  ///< posture by posture
};

}  // namespace stiffscope::calibration
