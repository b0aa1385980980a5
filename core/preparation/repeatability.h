#pragma once

#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/preparation/finding.h"
#include "metrology/measured_points.h"

namespace stiffscope::preparation {

/// How far repeats of one reflector in one load state scatter, in parts of the instrument's declared noise.
struct RepeatScatter {
  bool tested = false;
  Remark reason;             ///< why not
  double along_chi2 = 0.0;   ///< sum of squares along the beam over the declared variance
  double across_chi2 = 0.0;  ///< the same of both directions across it
  int along_dof = 0;
  int across_dof = 0;
  double along_rms = 0.0;                 ///< plain standard deviation of a reading, m
  double across_rms = 0.0;                ///< per direction, m
  std::vector<RejectedReading> outliers;  ///< repeats that stand apart from the others of their state
};

/// Readings that repeat another's coordinates to the last digit: the other copied, or the beam still on the other
/// reflector. Two readings of one reflector at one place come out alike by chance where the file has few digits:
/// with a last digit of r and a noise of s per coordinate, each pair does with the product of r / (2 sqrt(pi) s). As
/// many such pairs as chance gives a table (Poisson, at a thousandth) are none.
std::vector<RejectedReading> duplicateReadings(const campaign::Campaign& campaign);

/// From the loading's repeats. A repeat is an outlier where its squared distance from the mean of the others,
/// weighted by the declared noise (or by the campaign's own median scatter where that is larger), exceeds
/// chi-square's limit. Of two repeats both are named: nobody can tell which is wrong.
RepeatScatter repeatScatter(const campaign::Campaign& campaign);

/// The tracker's noise as campaign.xml declares it; empty without a tracker, or where a figure is zero: a
/// variance of zero weights nothing.
std::optional<metrology::TrackerNoise> declaredNoise(const campaign::Campaign& campaign);

/// By how much the repeats scatter beyond the declared noise where that is more than chance explains
/// (chi-square at the audit's level), at the upper end of what they leave open; else 1.
struct NoiseFactors {
  double along = 1.0, across = 1.0;
};

NoiseFactors noiseFactors(const RepeatScatter& scatter);

/// The tracker with its noise along and across the beam multiplied. The repeats' check names a tracker that
/// is noisier than declared; the other checks then hold the readings against what the repeats show, so that
/// one cause gives one finding (GUM 4.2: an evaluation from repeats outweighs a data sheet).
campaign::Tracker asNoisyAs(campaign::Tracker tracker, const NoiseFactors& factors);

/// Noise of one reading: by the scatter of repeats where there are enough of them (30 degrees of freedom along and
/// across the beam), in the shape of the declared noise; else as declared. Not known without a declared tracker.
struct NoiseModel {
  bool known = false;
  metrology::TrackerNoise noise;
  double along_factor = 1.0, across_factor = 1.0;  ///< standard deviations found against declared
  double degrees = 0.0;                            ///< of freedom of what it was found from; 0: as declared
  Remark source;
};

/// `campaign`: with its tracker as declared; `scatter`: of its repeats against that.
NoiseModel noiseModel(const campaign::Campaign& campaign, const RepeatScatter& scatter);

}  // namespace stiffscope::preparation
