#pragma once

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/gap_fit.h"

namespace stiffscope {

/// Where the gap lies that stiffnesses alone leave: the deflection's by reflector, axes of R0, axes of the
/// flange, along and across the beam, joint (what the angle of each joint alone would explain), posture, load
/// step and quarter of the time; that of unloaded positions by reflector, axes, beam and posture.
/// `parameters`: of all columns.
std::vector<WhereTable> whereDeflection(const GapInput& input, const GapFit& fit,
                                        const Eigen::VectorXd& parameters);
std::vector<WhereTable> wherePosition(const GapInput& input, const GapFit& fit,
                                      const Eigen::VectorXd& parameters);

/// What is left at each reflector, in the state of each posture that leaves the most before. The two data are of the same
/// readings, as they were and as they are used; a posture that either lacks is left out.
std::vector<PointGap> gapAtPoints(const GapData& data_before, const Eigen::VectorXd& before, const GapData& data_after,
                                  const Eigen::VectorXd& after);

}  // namespace stiffscope
