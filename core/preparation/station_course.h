#pragma once

#include "core/preparation/drift_nests.h"

namespace stiffscope::preparation {

/// What the floor nests say of the tracker: it stood, it jumped once, or it drifted or wandered. Not tested also where
/// the nests themselves moved against each other: they are then no reference.
enum class StationCourse { not_tested, still, jumped, drifted };

struct DriftModel {
  StationCourse course = StationCourse::not_tested;
  bool moved() const { return course == StationCourse::jumped || course == StationCourse::drifted; }

  StationMotion rounds;  ///< as the rounds of the nests show it, with its jumps
  StationMotion motion;  ///< the same smoothed: one jump, or a steady drift, where either fits
  /// A steady motion by all rounds: per second, rotation vector then displacement at `motion.centre`, in the
  /// axes of the readings; with its weight (inverse covariance). Zero where not tested.
  Eigen::Matrix<double, 6, 1> rate = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> rate_weight = Eigen::Matrix<double, 6, 6>::Zero();
  /// Where the rounds are not smoothed: covariance a second by which the station wanders between them, in the
  /// parameters of `rate`: interpolation leaves a Brownian bridge of it. Zero where a jump or a drift fits.
  Eigen::Matrix<double, 6, 6> wander = Eigen::Matrix<double, 6, 6>::Zero();
  double moved_by = 0.0;  ///< largest displacement where the arm was read, m
  Remark remark;          ///< the course, or why it was not tested
};

/// Covariance of a Brownian bridge between the rounds at two times, for a unit of it a second: (s - a)(b - t)
/// / (b - a) for s <= t between the same rounds a and b, else 0. s.
double bridgeBetweenRounds(const StationMotion& station, double one, double other);

/// Holds one jump (6 parameters and when) and a steady drift (6) against the rounds of the nests, by weighted
/// least squares; the better one is taken where it fits within its noise, else the rounds stay as they are
/// and the course is a drift.
DriftModel stationCourse(const campaign::Campaign& campaign, const std::optional<metrology::TrackerNoise>& noise);

}  // namespace stiffscope::preparation
