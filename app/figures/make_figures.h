#pragma once

#include <vector>

#include "reports/report_content.h"

namespace stiffscope::app {

struct FigureOptions {
  bool with_paper =
      false;  ///< the paper's means as dashed lines where the campaign's double encoders are declared
};

/// All pictures of a report, drawn: per campaign the deflection scene, all postures (up to 60), Fig. 7, Fig.
/// 8 (where PP and DPP both are available), the spread over subsets, the stiffnesses; what
/// is left by direction, the sweeps' circles and spheres, the station by the floor nests; what the model
/// misses, on the arm, by posture and by effect; then the double encoders where both states are there. What
/// the data does not have is left out. With several campaigns ids end in "-1", "-2", in their order, and
/// titles say which campaign. Throws std::runtime_error when offscreen rendering is not to be had.
std::vector<reports::Figure> makeFigures(const std::vector<reports::ReportCampaign>& campaigns,
                                const FigureOptions& options = {});

}  // namespace stiffscope::app
