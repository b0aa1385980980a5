#pragma once

#include "core/identification/subsets.h"

namespace stiffscope {

/// The distribution of one joint's stiffness over the subsets: Table II.
struct StiffnessSpread {
  double mean = 0.0, sd = 0.0;  ///< of k = 1/c, the paper's; heavy-tailed where c comes near zero
  double median = 0.0;
  double low = 0.0, high = 0.0;  ///< 5 % and 95 % quantiles
  double quartile_low = 0.0, quartile_high = 0.0;
  double compliance_mean = 0.0, compliance_sd = 0.0;
  double share_negative = 0.0;
};

StiffnessSpread spreadOf(const SubsetStudy& study, int joint);

}  // namespace stiffscope
