#pragma once

#include "core/audit/audit.h"
#include "core/diagnosis/diagnosis.h"

namespace stiffscope::audit {

/// Adds to the audit's `posture_set` which unmodelled effects these postures and loads could tell apart, which they
/// could not, and which they cannot test. A property of the design: `diagnosis` needs neither resamples nor chance
/// draws for it. Nothing where the check or the diagnosis could not be had.
void addSeparableEffects(const diagnosis::Diagnosis& diagnosis, AuditReport& report);

}  // namespace stiffscope::audit
