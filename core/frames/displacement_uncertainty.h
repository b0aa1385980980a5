#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "core/frames/frames.h"
#include "metrology/measured_points.h"

namespace stiffscope::frames {

/// The mean of the readings of one reflector in one load state.
struct MeanReading {
  int target = 0;
  Eigen::Vector3d in_r0 = Eigen::Vector3d::Zero();  ///< m
  int readings = 1;
};

/// What all displacements of a campaign have in common, in the order: error of R0 (6, FrameError), relative error of
/// the tracker's scale, radius of each target. Their joint covariance.
struct CommonTerms {
  static constexpr Eigen::Index kR0 = 0, kScale = 6, kRadii = 7;
  Eigen::MatrixXd covariance;
};

/// Of displacements whose table is in the frame of the sweeps. Displacements that came into R0 by the URDF alone have
/// nothing of R0's error: their caller sets its rows to zero.
CommonTerms commonTerms(const FramesCovariance& frames, double scale_sd = 0.0);

/// How the readings of one reflector, unloaded and loaded, move a displacement, and their covariances; R0 axes, m^2.
struct ReadingEffect {
  int target = 0;
  Eigen::Matrix3d by_unloaded, by_loaded;
  Eigen::Matrix3d unloaded, loaded;
};

/// The error of one displacement, split by what it shares with others: readings of the loaded state with nobody but
/// displacements of the same state, readings of step 0 with every step of the pose, and the common terms with all.
struct DisplacementUncertainty {
  int pose = 0, step = 0;
  std::vector<ReadingEffect> readings;
  Eigen::Matrix3Xd by_common;  ///< derivatives of the displacement by the common terms

  Eigen::Matrix3d loadedPart() const;
  Eigen::Matrix3d stepZeroPart() const;
};

/// Covariance of two displacements' errors, or of one with itself; 3x3, R0 axes, m^2.
Eigen::Matrix3d covarianceBetween(const DisplacementUncertainty& first, const DisplacementUncertainty& second,
                                  const CommonTerms& common);

/// How the readings of a campaign's loading were made. Repeats and directions by TrackerNoise; readings are
/// independent of each other.
struct LoadingReadings {
  metrology::TrackerNoise noise;
  Eigen::Isometry3d r0_from_loading = Eigen::Isometry3d::Identity();
  std::size_t targets = 0;  ///< of the campaign
};

/// Of a reflector's displacement, loaded less unloaded.
DisplacementUncertainty reflectorDisplacement(const LoadingReadings& how, int pose, int step,
                                              const MeanReading& unloaded, const MeanReading& loaded);

/// P_wrist by (13)-(20) in one load state: the three reflectors and the root that was taken.
struct TrilateratedState {
  std::array<MeanReading, 3> reflectors;
  Eigen::Vector3d wrist_in_r0 = Eigen::Vector3d::Zero();
};

/// Of P_wrist's displacement; both states with the same three reflectors in the same order, and the same radii, whose
/// errors nearly cancel. Empty where P_wrist stands in the plane of the reflectors.
std::optional<DisplacementUncertainty> wristDisplacement(const LoadingReadings& how, int pose, int step,
                                                         const TrilateratedState& unloaded,
                                                         const TrilateratedState& loaded);

}  // namespace stiffscope::frames
