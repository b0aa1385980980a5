#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/mistakes/readings_of_day.h"

namespace stiffscope::mistakes {

/// The unloaded readings against forward kinematics of the URDF's arm:
///
///   s R y + t = G(q) p_k + sum_j J_j(q, x) tau_j(q) c_j,
///
/// with the place of the base (R, t), the reflectors p_k in the flange, and where the URDF states masses the
/// compliances c_j under the own weight; the scale s is 1 unless it is to be found. Least squares over all readings, in
/// which a group of readings that stands apart from the median one has little weight (Cauchy). Nothing of the sweeps is
/// taken over into the arm, so that signs, order and units of joint angles show, which a measured arm takes up.
struct NominalFit {
  bool done = false;  ///< readings enough, and some in a posture of the loading or in sweeps of two axes
  Eigen::Isometry3d base_from_points = Eigen::Isometry3d::Identity();
  double scale = 1.0;
  std::vector<Eigen::Vector3d> reflectors_in_flange;
  JointVector compliance;         ///< by the own weight; rad/Nm; none: rigid
  double sag_factor = 1.0;        ///< of the sag by `NominalFitOptions::springs`
  double rms = 0.0;               ///< of all readings, distances, m
  std::vector<double> group_rms;  ///< by group, m; 0 for one without readings
  double typical = 0.0;           ///< median over the groups, m

  /// Root mean square over the groups but for the worst twentieth, at least one, m: a table whose rows are shifted has
  /// one at its end that fits nowhere.
  double rmsButForWorst() const;

  /// One reading in the base, as measured and as modelled, m; and their distance.
  Eigen::Vector3d measuredPoint(const UnloadedReading& reading) const;
  Eigen::Vector3d modelledPoint(const ReadingsOfDay& day, const UnloadedReading& reading) const;
  double missOf(const ReadingsOfDay& day, const UnloadedReading& reading) const;
};

struct NominalFitOptions {
  bool sag = true;
  bool scale = false;
  std::optional<JointVector> springs = {};  ///< compliances that sag by one factor, instead of each by its own; rad/Nm
};

NominalFit fitNominal(const ReadingsOfDay& day, const NominalFitOptions& options = {});

/// Root mean square that is left, m, where any linear map may carry the readings into the base: a lower bound of the
/// fit's without sag, at a tenth of its time. It does not see what a map can do: mirror, scale or shear the readings.
double affineMisfit(const ReadingsOfDay& day);

}  // namespace stiffscope::mistakes
