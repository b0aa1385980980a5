#pragma once

#include <string>
#include <vector>

#include "core/audit/finding.h"

namespace stiffscope {

/// How far repeats of one reflector in one load state scatter, in parts of the instrument's declared noise.
struct RepeatScatter {
  bool tested = false;
  std::string reason;        ///< why not
  double along_chi2 = 0.0;   ///< sum of squares along the beam over the declared variance
  double across_chi2 = 0.0;  ///< the same of both directions across it
  int along_dof = 0;
  int across_dof = 0;
  double along_rms = 0.0;                 ///< plain standard deviation of a reading, m
  double across_rms = 0.0;                ///< per direction, m
  std::vector<RejectedReading> outliers;  ///< repeats that stand apart from the others of their state
};

/// From the loading's repeats. A repeat is an outlier where its squared distance from the mean of the others,
/// weighted by the declared noise (or by the campaign's own median scatter where that is larger), exceeds
/// chi-square's limit. Of two repeats both are named: nobody can tell which is wrong.
RepeatScatter repeatScatter(const Campaign& campaign);

}  // namespace stiffscope
