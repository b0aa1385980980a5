#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/calibration/calibrate.h"
#include "core/calibration/fitted_arm.h"
#include "core/calibration/fitted_day.h"
#include "core/robot/robot.h"

namespace stiffscope::comparison {

/// A fit's equations about where it ended, posture by posture, and what it left: all in parts of the readings'
/// covariance.
struct FitEquations {
  std::vector<std::size_t> postures;  ///< in the day, with readings used
  std::vector<calibration::PostureEquations> equations;
  Eigen::MatrixXd normal_inverse;  ///< of the unknowns, the prior in it
  int joints = 0;                  ///< of the machine

  FitEquations(const calibration::UnloadedDay& day, const calibration::ArmFit& fit);
};

/// What the model leaves, as variances: of each coordinate by itself, and of each joint's angle, rad^2, which moves all
/// reflectors of a posture together. What gears do differs from posture to posture like an error of the angle, and
/// makes a joint's zero more uncertain than errors of single coordinates would.
struct ErrorComponents {
  explicit ErrorComponents(int joints) : angle(JointVector::Zero(joints)) {}

  double coordinate = 1.0;
  JointVector angle;
};

/// By moments of the residuals (C. R. Rao, J. Multivariate Anal. 1 (1971) 257): with V their covariance by such errors,
/// P = V^-1 - V^-1 J (J^T V^-1 J)^-1 J^T V^-1, M_0 the identity, and for each joint M_k the sum over postures of a a^T,
/// a what a turn of it does to the readings,
///   E(r^T P M_k P r) = sum_l theta_l tr(P M_k P M_l),
/// solved for theta = (s, t_1..); variances that come out negative are none, s is no less than `least_coordinate`. V is
/// first the identity, then by what was found, in turns until it stays: joints may err by much more than coordinates,
/// and with weights of 1 their scatter would hide what that of a coordinate is. `residuals`: of each posture of `fit`,
/// as long as its equations.
ErrorComponents errorComponents(const FitEquations& fit, const std::vector<Eigen::VectorXd>& residuals,
                                double least_coordinate = 0.0);

/// Covariance of the unknowns by such errors: N^-1 J^T S J N^-1, and the prior's share.
Eigen::MatrixXd covarianceBy(const FitEquations& fit, const ErrorComponents& errors);

/// One reading of a day: its posture, and its place in the day's order of readings.
struct Place {
  std::size_t posture = 0, reading = 0;
};

struct CommonReading {
  Place before, after;
};

/// What two days without a load have in common.
struct CommonReadings {
  std::array<std::vector<int>, 2> targets;  ///< reflectors of the same id, in each day's numbers
  std::vector<CommonReading> readings;  ///< of the same reflector in the same posture, in the order of the day before
  std::size_t postures = 0;
};

/// Postures correspond where the pose id is the same and no joint angle differs by more than MatchLimits says.
CommonReadings commonReadings(const calibration::UnloadedDay& before, const calibration::UnloadedDay& after);

/// Whether an effect is the machine's; the others are of one day's time.
bool ofMachine(const calibration::EffectPart& part);

/// Two calibrated days of one machine, each fitted again (geometry, base, reflectors, effects) so that what the fits
/// differ by is the machine's change. Where half of the postures of the shorter day or more are in both, their common
/// readings alone are fitted, where what the model misses cancels; of the machine's effects the joints' compliances by
/// own weight take part, if the URDF has masses. Else effects of either day that are the machine's are fitted in both;
/// a compliance that either day refuses is in neither, since two models would differ by more than the days do. Effects
/// of time are each day's own.
class PairedDays {
 public:
  explicit PairedDays(std::array<calibration::Calibration, 2> days);

  const calibration::UnloadedDay& day(std::size_t k) const { return days_[k].day; }
  /// By how much reflectors of one posture err together, as far as the fit's covariance has it.
  double designEffectOf(std::size_t k) const { return fits[k].model_sd > 0.0 ? fits[k].design_effect : 1.0; }

  std::array<std::vector<int>, 2> targets;  ///< of both days, in each one's numbers
  std::size_t postures_common = 0;
  bool same_postures = false;  ///< fitted on the common readings alone
  std::array<calibration::ArmFit, 2> fits;
  /// Covariance of each fit's unknowns: by what it leaves, or on the same postures by what the difference of both
  /// leaves, where what the model misses cancels; then each has half of it.
  std::array<Eigen::MatrixXd, 2> covariances;
  std::array<double, 2> left{};  ///< rms of the 3-D position by each fit, m
  std::array<double, 2> rows{};  ///< equations of each fit

 private:
  void matchReadings();
  std::vector<calibration::EffectPart> partsOf(std::size_t k) const;
  void fit();
  void fitDay(std::size_t k, const std::vector<calibration::EffectPart>& parts);
  void setCovariances();
  /// What the tracker declares, as the least variance of a coordinate of the residuals of day k, or of their difference
  /// from the other day's: in parts of the covariance that whitens them.
  double leastCoordinate(std::size_t k) const;
  /// What the residuals of the two days differ by in each posture of day k, in parts of that day's covariance.
  std::vector<Eigen::VectorXd> differences(std::size_t k, const FitEquations& equations) const;

  std::array<calibration::Calibration, 2> days_;
  std::vector<CommonReading> common_;
  std::array<std::vector<Eigen::Vector3d>, 2> residuals_;
};

}  // namespace stiffscope::comparison
