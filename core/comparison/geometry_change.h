#pragma once

#include <string>
#include <vector>

#include "core/calibration/calibrate.h"
#include "core/comparison/change_causes.h"
#include "core/comparison/geometry_numbers.h"
#include "core/comparison/paired_fit.h"
#include "core/comparison/remarks.h"
#include "metrology/remark.h"

namespace stiffscope::comparison {

/// Significance of any change at all, machine and reflectors together: of two days of an unchanged machine one pair in
/// a hundred is said to have changed.
inline constexpr double kChangeLevel = 0.01;

struct NumberChange {
  GeometryNumber number;
  Uncertain difference;     ///< after - before, m or rad
  double p_value = 0.0;     ///< two-sided, of no difference
  double p_holm = 0.0;      ///< the same corrected for how many numbers are tested
  double at_targets = 0.0;  ///< rms of the 3-D position by it alone, beyond base and reflectors, m
  bool identified = true;   ///< false: the postures of a day hardly see it; no test then
};

struct ReflectorChange {
  std::string target;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero(), sd = Eigen::Vector3d::Zero();  ///< flange axes, m
  double p_value = 0.0, p_holm = 0.0;                                             ///< of no shift
};

/// How the base stands against the tracker, after against before, in base_link: no change of the machine.
struct BaseChange {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), shift = Eigen::Vector3d::Zero();  ///< rad, m
};

/// Two days without a load of one machine.
struct GeometryChange {
  Remark reason;  ///< why there is no comparison; then nothing else is filled
  std::vector<Remark> cautions;
  std::size_t postures_before = 0, postures_after = 0, postures_common = 0;
  bool same_postures = false;                  ///< compared on those of both alone: what the model misses cancels
  double left_before = 0.0, left_after = 0.0;  ///< rms of the 3-D position by the models compared, m
  std::vector<std::string> effects;            ///< ids of effects fitted beside the geometry in both
  double effects_p = 1.0;                      ///< of sizes of these effects that are the same in both days
  bool effects_changed = false;                ///< they are not, and each day has its own
  std::vector<NumberChange> numbers;
  std::vector<ReflectorChange> reflectors;  ///< those of both days
  BaseChange base;
  double chi2 = 0.0;  ///< of all numbers of the machine together
  int unknowns = 0;
  double machine_p = 1.0;             ///< of an unchanged machine
  double reflectors_p = 1.0;          ///< of unmoved reflectors
  double at_targets = 0.0;            ///< rms of the 3-D position by the machine's change, m
  double at_targets_sd = 0.0;         ///< what chance alone makes of it, m
  std::vector<CauseEvidence> causes;  ///< best first; of the machine where that changed, else of the reflectors
  bool machine_changed = false, reflectors_moved = false;

  /// The best cause leaves nothing but chance.
  bool explained() const { return !causes.empty() && causes.front().left_p >= kChangeLevel; }
};

/// Fits both days, each by the geometry with its base and reflectors, and tests the difference of what a machine keeps
/// (GeometryNumbers): d = n_after - n_before, covariance C from both fits; chi2 = d^T C^-1 d against F. Where half of
/// the postures or more are in both days, these alone are fitted, with the joints' compliances by own weight where the
/// URDF has masses, and C is by what the difference of the two residuals leaves, in which what the model misses
/// cancels; else effects of either day that are the machine's are fitted in both. Either way they have the same sizes
/// in both days unless these differ: a joint that has become softer is no change of the geometry. Effects of time
/// (drift, jumps, growth) are each day's own. Causes: d = G s, s by generalised least squares, each alone.
GeometryChange compareGeometry(const campaign::Campaign& before, const campaign::Campaign& after);

}  // namespace stiffscope::comparison
