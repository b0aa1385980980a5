#pragma once

#include "core/audit/audit.h"
#include "core/diagnosis/diagnosis.h"

namespace stiffscope::audit {

/// Adds to the audit's `posture_set` which unmodelled effects these postures and loads could tell apart, which they
/// could not, and which they cannot test. A property of the design: `diagnosis` needs neither resamples nor chance
/// draws for it. Those of a rail are not spoken of for an arm on none. Nothing where the check or the diagnosis could
/// not be had.
void addSeparableEffects(const diagnosis::Diagnosis& diagnosis, bool on_rail, AuditReport& report);

}  // namespace stiffscope::audit
