#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/effects/all.h"
#include "core/effects/effect_model.h"
#include "core/frames/arm_geometry.h"
#include "core/preparation/station_course.h"
#include "metrology/measured_points.h"

namespace stiffscope::diagnosis {

/// What is known of the compliances before the gap is looked at, and how well (sd), rad/Nm: as
/// identification has them, give or take three times as much; where the load says nothing of a joint, half of
/// its weaker neighbour's, give or take as much. Without it a joint that no load turns takes any stiffness,
/// and what is computed with it anything.
struct ComplianceExpected {
  JointVector value, sd;    ///< sd 0, or empty: nothing is known
  std::vector<bool> known;  ///< whether identification has it; empty: not said
};

/// What the gap stands on, fixed for one diagnosis.
struct SystemInput {
  const campaign::Campaign& campaign;  ///< screened, corrected for the station's motion where nests show it
  metrology::TrackerNoise noise;       ///< by the repeats where there are enough, else as declared
  double force_sigma = 0.0, moment_sigma = 0.0;
  std::vector<effects::EffectModel> models;
  bool absolute = false;  ///< unloaded absolute positions can be held against the arm
  bool sweeps = false;    ///< and the sweeps too
  ComplianceExpected expected;
  /// What nests say of trackerDrift's parameters: their values, and the inverse covariance of these.
  Vector6d drift = Vector6d::Zero();
  Matrix6d drift_weight = Matrix6d::Zero();
  const preparation::DriftModel* wandering = nullptr;  ///< whose interpolated motion was corrected for; null: none
  /// Of where the carriage of a rail stands in one posture, in the axes of the readings (RailCourse::of_stop); zero
  /// where it stands still.
  Eigen::Matrix3d carriage = Eigen::Matrix3d::Zero();
};

/// Where one round of linearisation stands.
struct SystemState {
  SystemState() = default;  ///< of no machine yet
  explicit SystemState(int joints) : at(joints) {}

  frames::LoadingGeometry geometry;
  Eigen::Isometry3d r0_from_sweeps = Eigen::Isometry3d::Identity();
  effects::LinearizationPoint at;
  effects::Corrections corrections;
  double sweep_inflation = 1.0, position_inflation = 1.0;  ///< factors on the variances of absolute positions
  double model_error = 0.0;  ///< rms per coordinate of what no effect explains, at the largest load, m
};

}  // namespace stiffscope::diagnosis
