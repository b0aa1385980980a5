#pragma once

#include <Eigen/Core>

#include "core/frames/arm_in_r0.h"
#include "core/frames/axes_covariance.h"
#include "core/frames/link_geometry.h"
#include "core/frames/wrist_centre.h"
#include "metrology/frame_error.h"

namespace stiffscope {

/// Joint covariance of what the sweeps give, with everything that they have in common: R0 in all that is expressed in
/// it, an axis in the two links that it ends, the sag's stiffnesses in everything. In the order
///   error of R0: rotation vector, origin (FrameError: R0 as measured against the true one, in R0's axes),
///   five distances and five angles between consecutive axes,
///   the wrist centre at the wrist sweep's posture, in R0 as measured,
///   the radius of each target of the campaign;
/// rad and m; rows of what was not measured are zero.
struct FramesCovariance {
  static constexpr Eigen::Index kR0 = 0, kDistances = 6, kAngles = 11, kWristCentre = 16, kRadii = 19;

  Eigen::MatrixXd readings;  ///< by the noise of the sweeps' readings
  Eigen::MatrixXd sag;       ///< by the covariance of the stiffnesses with which the arm's sag was taken off
  Eigen::VectorXd by_scale;  ///< how a relative error of the tracker's scale, common to all readings, moves each

  /// `scale_sd` is the relative standard uncertainty of the tracker's scale. The campaign format has none; 1 K of air
  /// temperature that is not known makes 1e-6 (Edlen's equation of the refractive index of air).
  Eigen::MatrixXd total(double scale_sd = 0.0) const;
  FrameCovariance r0() const { return total().topLeftCorner<6, 6>(); }
};

/// By the law of propagation (GUM 5.2.2), with `sag` zero. Size 19 + the campaign's targets; all zero where R0 is not
/// placed in the frame of the readings. `station`: the tracker's, in that frame.
FramesCovariance framesCovariance(const std::array<MeasuredAxis, 6>& axes, const ArmInR0& arm,
                                  const std::array<LinkGeometry, 5>& links, const WristCentre& wrist,
                                  std::size_t targets, const Eigen::Vector3d& station);

/// Puts the standard uncertainties into links and wrist.
void stateUncertainties(const FramesCovariance& covariance, const std::array<MeasuredAxis, 6>& axes,
                        const ArmInR0& arm, std::array<LinkGeometry, 5>& links, WristCentre& wrist);

}  // namespace stiffscope
