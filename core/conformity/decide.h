#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/calibration/calibrate.h"
#include "core/comparison/deflection_avoided.h"
#include "core/identification/identification.h"
#include "core/workspace/workspace_stiffness.h"

namespace stiffscope::conformity {

/// What a limit can be on, in the unit that its name ends in. Of a loaded day: the stiffnesses, of as many joints as
/// the machine has, by the method shown first, what it compensates on postures held out, the softest direction at P_TCP
/// over the day's postures, and, of a pair, what active encoders avoid. Of an unloaded day: position errors on postures
/// held out, by the URDF's arm and by the calibrated one. Of circle sweeps: the largest difference of a distance
/// between axes from the URDF's.
enum class Quantity {
  k1,
  k2,
  k3,
  k4,
  k5,
  k6,
  k7,
  k8,
  compensated_at_reflectors,
  compensated_at_wrist,
  softest,
  avoided,
  nominal_rms,
  nominal_largest,
  calibrated_rms,
  calibrated_largest,
  link_difference
};

/// The name of a quantity in a file of limits and its unit in SI: a value in the file times `unit` is SI.
struct QuantityName {
  Quantity quantity;
  const char* name;
  double unit;
};

/// All quantities, in the order of the enumeration.
const std::vector<QuantityName>& quantityNames();
const QuantityName& nameOf(Quantity quantity);

/// One acceptance limit, SI: the quantity is to be at least, or at most, this. One of the two may be absent.
struct Limit {
  Quantity quantity = Quantity::k1;
  std::optional<double> least, most;
  std::string reason;    ///< who asks for it and why, as the file says
  std::size_t line = 0;  ///< in the file
};

/// A file of limits.
struct Limits {
  std::string file;    ///< its bare name
  std::string sha256;  ///< of its bytes
  std::vector<Limit> limits;
};

/// Reads a table (CSV) of the columns `name`, `least`, `most`, `reason`: a row a limit. Throws InputError, with file,
/// line, column and value, for a name that is not known (with the nearest that is) or stands there twice, a number that
/// is none, a row without a number or with `least` above `most`, and a row without a reason.
Limits readLimits(const std::filesystem::path& path);

enum class Verdict { pass, fail, not_evaluated };

/// Why a limit was not evaluated.
enum class Missing {
  nothing,
  not_of_such_a_day,  ///< the day measures something else
  no_such_joint,      ///< the machine has fewer
  not_identified,     ///< of such a day, but not found on this one
  sag_left_in,        ///< of sweeps whose uncertainties know nothing of the arm's own sag
  no_uncertainty      ///< too little was measured to say how far it is to be trusted
};

/// A quantity as measured, SI, with its 95 % interval.
struct Measured {
  double value = 0.0;
  identification::CoverageInterval interval;
};

/// What came of one limit.
struct Decision {
  Limit limit;
  std::optional<Measured> measured;
  Verdict verdict = Verdict::not_evaluated;
  bool in_guard_band = false;  ///< fails although the value itself keeps the limit
  Missing missing = Missing::nothing;
};

/// What a day measured; what it has not is null.
struct DayResult {
  const identification::Identification* identification = nullptr;  ///< of a loaded day
  const frames::Frames* swept = nullptr;                           ///< where circles were swept
  const workspace::WorkspaceStiffness* workspace = nullptr;
  const calibration::Calibration* calibration = nullptr;   ///< of an unloaded day
  const comparison::DeflectionAvoided* avoided = nullptr;  ///< by this day's encoders, against another day
};

/// Guarded acceptance with the guard band w = U (JCGM 106:2012, 8.3.2; ISO 14253-1): a limit is kept where the whole 95
/// % interval of the quantity keeps it, value - U >= least and value + U <= most, U to each side the distance of the
/// interval's end. The chance of accepting what is outside is then 2.5 % at most for one limit. Everything else fails,
/// `in_guard_band` where the value itself keeps the limit.
Decision decide(const Limit& limit, const Measured& measured);

/// Each limit by what the day measured. U of a share compensated is from its spread over the subsets of postures, of an
/// error of position from the tracker's declared noise, of a distance between axes from their fit; the others state an
/// interval of their own. Where a joint of unknown stiffness moves P_TCP in some posture, the softest direction that is
/// known is an upper bound of the softest one, with an interval from zero: it fails a lower limit where all of it lies
/// below, passes an upper one as any quantity does, and is else not evaluated.
std::vector<Decision> decide(const Limits& limits, const DayResult& day);

/// Over the days of a report, whose decisions are of the same limits in one order: fail where one fails; pass where
/// each limit passes on some day and was evaluated on all days that measure what it is on; else not evaluated.
Verdict overall(const std::vector<std::vector<Decision>>& by_day);

}  // namespace stiffscope::conformity
