#pragma once

#include <optional>
#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/fit.h"
#include "core/diagnosis/held_out.h"
#include "core/preparation/prepare.h"

namespace stiffscope::diagnosis {

/// What stiffnesses alone leave of the readings as they were, the station's motion in them.
struct GapAsMeasured {
  std::optional<double> deflection, position;  ///< rms per coordinate, m; empty: no such readings
  WhereTable by_posture;                       ///< of the deflection
  std::vector<PointGap> at_points;
  /// By posture of `fit`, by what is fitted to the others: before, of these readings; after, of `fit`. Positions before
  /// are those of the arm as the sweeps have it, which nothing here is fitted to.
  std::vector<HeldOut> left;
};

/// The gap of the readings with the motion of the station put back; `after`: parameters (allParameters) of the
/// equations of `fit`, `after_without` those without each of its postures (parametersWithoutEach). The stiffnesses are
/// fitted in the arm as the sweeps have it: a geometry left free would follow the station. Empty where nothing can be
/// fitted.
std::optional<GapAsMeasured> gapAsMeasured(const preparation::PreparedCampaign& prepared, const SystemInput& input,
                                           const GapFit& fit, const Eigen::VectorXd& after,
                                           const std::vector<Eigen::VectorXd>& after_without);

/// How large the gap of the deflection is, rms per coordinate: left by stiffnesses alone (`before`, on the
/// equations of `alone`, withoutEffects), by noise, and by `after`, a parameter vector (allParameters) of the
/// equations of `fit`.
Gap deflectionGap(const GapFit& alone, const StiffnessesAlone& before, const GapFit& fit, const Eigen::VectorXd& after);

/// The gap of the unloaded absolute positions; all zero where they are not held against the arm.
Gap positionGap(const GapFit& alone, const StiffnessesAlone& before, const GapFit& fit, const Eigen::VectorXd& after);

/// What a fit leaves of unloaded positions beyond their noise, and what the repeatability of an arm, or a tenth of what
/// the fit takes off, may leave, m.
struct PositionsLeft {
  double left = 0.0, limit = 0.0;
  bool beyondLimit() const { return left > limit; }
};
PositionsLeft positionsLeft(const GapFit& fit, const Gap& positions);

/// Where the gap lies that stiffnesses alone leave: the deflection's by reflector, axes of R0, axes of the
/// flange, along and across the beam, joint (what angles of the joints would explain, shared out among them), posture,
/// load step and quarter of the time; that of unloaded positions by reflector, axes, beam and posture. `parameters`: of
/// all columns.
std::vector<WhereTable> whereDeflection(const SystemInput& input, const GapFit& fit, const Eigen::VectorXd& parameters);
std::vector<WhereTable> wherePosition(const SystemInput& input, const GapFit& fit, const Eigen::VectorXd& parameters);

/// What is left at each reflector, in the state of each posture that leaves the most before. The two data are of the
/// same readings, as they were and as they are used; a posture that either lacks is left out.
std::vector<PointGap> gapAtPoints(const LinearSystem& data_before, const Eigen::VectorXd& before,
                                  const LinearSystem& data_after, const Eigen::VectorXd& after);

}  // namespace stiffscope::diagnosis
