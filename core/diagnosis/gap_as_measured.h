#pragma once

#include <optional>
#include <vector>

#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/gap_fit.h"
#include "core/diagnosis/held_out.h"

namespace stiffscope {

/// What stiffnesses alone leave of the readings as they were, the station's motion in them.
struct GapAsMeasured {
  std::optional<double> deflection, position;  ///< rms per coordinate, m; empty: no such readings
  WhereTable by_posture;                       ///< of the deflection
  std::vector<PointGap> at_points;
  std::vector<HeldOut>
      left;  ///< by posture of `fit`: before, of these readings; after, of `fit` with `after`
};

/// `original`: nothing taken off; `after`: parameters (allParameters) of the equations of `fit`. The
/// stiffnesses are fitted in the arm as the sweeps have it: a geometry left free would follow the station.
/// Empty where nothing can be fitted.
std::optional<GapAsMeasured> gapAsMeasured(const Campaign& original, const GapInput& input, const GapFit& fit,
                                           const Eigen::VectorXd& after);

}  // namespace stiffscope
