#pragma once

#include "core/diagnosis/gap_data.h"

namespace stiffscope {

/// Covariance of one posture's rows (position rows first, then deflection rows state by state), m^2. All
/// displacements of a posture share its unloaded readings, and a state's coordinates its wrench.
struct GapCovariance {
  Eigen::MatrixXd by_measuring;  ///< readings, wrench, and a station between its rounds
  Eigen::MatrixXd whole;         ///< with the slack of positions and the error of the model
  double displacement_trace = 0.0,
         displacements = 0.0;  ///< readings' variances of displacements, and how many
};

GapCovariance gapCovariance(const GapInput& input, const GapState& state, const GapRows& rows,
                            Eigen::Index position_rows);

}  // namespace stiffscope
