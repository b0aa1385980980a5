#pragma once

#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/preparation/declared_noise.h"
#include "core/preparation/finding.h"
#include "metrology/measured_points.h"

namespace stiffscope::preparation {

/// How far repeats of one reflector in one load state scatter, in parts of the instrument's declared noise, with what
/// the rounding of its readings adds.
struct RepeatScatter {
  bool tested = false;
  Remark reason;             ///< why not
  double along_chi2 = 0.0;   ///< sum of squares along the beam over the declared variance
  double across_chi2 = 0.0;  ///< the same of both directions across it
  int along_dof = 0;
  int across_dof = 0;
  double along_rms = 0.0;                 ///< plain standard deviation of a reading, m
  double across_rms = 0.0;                ///< per direction, m
  double typical = 1.0;                   ///< of a reading by the median, which outliers do not pull; 1: not tested
  double digit = 0.0;                     ///< the last one of the readings, m, where it adds to the noise; else 0
  std::vector<RejectedReading> outliers;  ///< repeats that stand apart from the others of their state
};

/// Readings that repeat another's coordinates to the last digit: the other copied, or the beam still on the other
/// reflector. Two readings of one reflector at one place come out alike by chance where the file has few digits: each
/// pair with the product over the coordinates of about r / (2 sqrt(pi) s), r the last digit and s the noise (as
/// declared, or as the repeats show it where that is less). Of n repeats there are n (n - 1) / 2 pairs, and more with
/// those of other load steps as near as the load leaves them. No more repeated readings in a table than chance makes
/// pairs (Poisson, at a thousandth a day) are none: all of them are kept. Of readings elsewhere none is by chance.
std::vector<RejectedReading> duplicateReadings(const campaign::Campaign& campaign);

/// From the loading's repeats. A repeat is an outlier where its squared distance from the mean of the others,
/// weighted by the declared noise (or by the campaign's own median scatter where that is larger), exceeds
/// chi-square's limit. Of two repeats both are named: nobody can tell which is wrong.
/// `rounded`: of the readings of the arm, as they were read.
RepeatScatter repeatScatter(const campaign::Campaign& campaign, const Rounded& rounded);

/// By how much the repeats scatter beyond the declared noise and the rounding where that is more than chance explains
/// (chi-square at the audit's level), at the upper end of what they leave open; else 1.
NoiseFactors noiseFactors(const RepeatScatter& scatter);

/// The noise of a reading by the distances between reflectors, which the arm carries about unchanged: for a day whose
/// states were read once, so that no repeats tell it. Along the beam and across it together.
struct DistanceScatter {
  double ratio = 1.0;    ///< variance of a reading, found over declared
  double degrees = 0.0;  ///< of freedom of that; 0: there are no distances to compare
  /// Whether chance alone takes the ratio so far from 1 (two of its standard deviations).
  bool asDeclared() const;
};

/// Of each two reflectors that were read in one state from one station, the change of their distance from one posture
/// to the next under the same load step, over its variance by the declared noise. The median of the squares stands for
/// all: a reflector that slips once, or is knocked, makes one change. What the load does to a plate under the
/// reflectors stays out, since the steps are the same; a plate that gives differently from posture to posture counts as
/// noise.
///
/// Degrees of freedom: a median is worth 0.37 of its sample, changes that share a posture 2/3 (von Neumann), and of the
/// distances among n reflectors 3 n - 6 are independent.
DistanceScatter distanceScatter(const campaign::Campaign& campaign, const metrology::TrackerNoise& noise);

/// Noise of one reading: by the scatter of repeats where there are enough of them (30 degrees of freedom along and
/// across the beam), in the shape of the declared noise; else by the distances between reflectors
/// (DistanceScatter), where these tell it by as many and contradict what is declared; else as declared. Not known
/// without a declared tracker.
struct NoiseModel {
  bool known = false;
  metrology::TrackerNoise noise;
  double along_factor = 1.0, across_factor = 1.0;  ///< standard deviations found against declared
  double degrees = 0.0;                            ///< of freedom of what it was found from; 0: as declared
  Remark source;
};

/// `campaign`: with its tracker as declared; `scatter`: of its repeats against that and `rounded`, which is in the
/// noise.
NoiseModel noiseModel(const campaign::Campaign& campaign, const RepeatScatter& scatter, const Rounded& rounded);

}  // namespace stiffscope::preparation
