#pragma once

#include <vector>

#include "core/audit/audit_input.h"
#include "core/mistakes/suspected.h"

namespace stiffscope::audit {

/// A sum of squares over the declared variance, chi-square with `dof` degrees of freedom where only noise is in it.
struct NoiseSum {
  double chi2 = 0.0;
  int dof = 0;
  double ratio() const;  ///< standard deviation found against declared; 0 without degrees of freedom
};

/// What a day's readings say of one instrument's declared noise.
struct DeclaredNoise {
  Remark where;   ///< the instrument
  Remark reason;  ///< why nothing can be said; empty where something can
  /// Its figures found against declared where these are wrong by more than a factor of two, else 1: of the tracker
  /// along and across the beam, of the load cell one for all.
  std::vector<double> factors;
  double deviation = 1.0;            ///< larger of factor and its inverse that the readings bear out
  bool too_large = false;            ///< declared is more than twice of what is found
  bool too_small = false;            ///< declared is less than half of what is found
  std::vector<Remark> evidence;      ///< each kind of readings with its ratio
  double before = 0.0, after = 0.0;  ///< ratio of the readings over the day, with the figures as declared and as found
};

/// The tracker, then the load cell, by readings that agree on it.
///
/// At once: repeats of one state, along and across the beam; the load cell's unloaded readings about their mean. They
/// give the size. Over the day: what rounds of floor nests, circles of each swept axis and returns to zero leave; the
/// load cell's moments against one lever. Whatever else is wrong adds to these, so the smallest of them is taken, and
/// it has to be beyond chance on the same side. Repeats within seconds that are quiet while the day is as noisy as
/// declared are no wrong declaration, nor is one kind of readings that scatters where another does not.
///
/// A ratio of two, as between standard deviation and the stated interval of most data sheets. A kind has a say from
/// thirty degrees of freedom on: chance makes two of one in less than one day in 50 000.
std::vector<DeclaredNoise> judgeDeclaredNoise(const AuditInput& input);

/// Those of the instruments whose figures are wrong, with the figures that the readings show.
std::vector<mistakes::Suspected> suspectedNoise(const AuditInput& input);

/// How far reflectors of postures unloaded again stand from step 0, of all postures together; core/audit/checks.h:
/// return_to_zero. None where nothing was unloaded again.
NoiseSum scatterOfReturns(const AuditInput& input);

}  // namespace stiffscope::audit
